// Counts the parts of an XML file before tinyxml2 parses it, because tinyxml2 has no limits of its own: it compares each
// attribute with all others of its element.
#pragma once

#include <cstddef>
#include <string_view>

namespace tactus::sim::sdf {

struct XmlCount {
  std::size_t parts = 0;            // elements, with their ends, attributes, and comments and the like
  std::size_t max_attributes = 0;  // of one element
  int line = 1;                     // of that element
};

// Linear in the size of the text. A file that is not well-formed has any count; tinyxml2 refuses it.
XmlCount count_xml(std::string_view text);

// The name of the encoding of a text that begins as no XML in UTF-8 can: "UTF-16" or "UTF-32"; "": it may be UTF-8.
std::string_view other_encoding(std::string_view text);

}  // namespace tactus::sim::sdf
