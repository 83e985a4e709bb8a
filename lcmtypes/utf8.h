// Text in UTF-8: its characters (code points), and cuts between them. Pure.
#pragma once

#include <cstddef>
#include <string_view>

namespace tactus {

// Bytes of the well-formed character at the beginning of the text, 1 .. 4; 0: the text is empty or begins with no such character. Source: the
// Unicode Standard 15.0, table 3-7.
std::size_t utf8_bytes(std::string_view text);

// As utf8_bytes(), but 0 for a control character (U+0000 .. U+001F, U+007F .. U+009F).
std::size_t shown_bytes(std::string_view text);

// Whether all of it is well-formed and printable on one line: no control character, and no line or paragraph separator (U+2028, U+2029).
bool is_text_line(std::string_view text);

// Number of characters. A byte that belongs to no well-formed character counts as one.
std::size_t character_count(std::string_view text);

// The first `count` characters, or all: a cut at a number of bytes may lie inside a character.
std::string_view first_characters(std::string_view text, std::size_t count);

// The longest beginning of at most this number of bytes that ends between two characters.
std::string_view first_bytes(std::string_view text, std::size_t bytes);

}  // namespace tactus
