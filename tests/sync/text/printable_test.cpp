#include "sync/text/printable.h"

#include <catch2/catch.hpp>

using tactus::sync::printable;

TEST_CASE("Control characters in text for a terminal are escaped") {
  CHECK(printable("audio_node: 48 kHz, \\ \"quoted\"") == "audio_node: 48 kHz, \\ \"quoted\"");
  CHECK(printable("m\xc3\xbcller \xe2\x82\xac \xf0\x9f\x8e\xb5") == "m\xc3\xbcller \xe2\x82\xac \xf0\x9f\x8e\xb5");
  CHECK(printable("\x1b[2Jgone\a\x7f\r\n") == "\\x1b[2Jgone\\x07\\x7f\\x0d\\x0a");
  CHECK(printable("\xc2\x9b" "2J") == "\\xc2\\x9b2J");  // the same control sequence in one character
  CHECK(printable("\xff\xc3") == "\\xff\\xc3");
}

TEST_CASE("Malformed UTF-8 is escaped: long forms, surrogates, code points above the last, truncated characters") {
  CHECK(printable("\xe0\x80\xaf") == "\\xe0\\x80\\xaf");          // '/' in three bytes
  CHECK(printable("\xc0\xaf") == "\\xc0\\xaf");                    // and in two
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");          // a surrogate, U+D800
  CHECK(printable("\xf0\x8f\xbf\xbf") == "\\xf0\\x8f\\xbf\\xbf");  // U+FFFF in four bytes
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // U+110000
  CHECK(printable("\xe2\x82") == "\\xe2\\x82");
  CHECK(printable("\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbf") == "\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbf");  // the neighbours
}
