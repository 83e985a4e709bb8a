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
