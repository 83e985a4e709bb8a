// Tests of parsing LCM datagrams and fragments.
#include "sync/bus/datagram.h"

#include <catch2/catch.hpp>
#include <random>
#include <string>

using namespace tactus;
using namespace tactus::sync;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

const std::string kNumber("\0\0\0\7", 4);

Bytes short_message(const std::string& channel, const std::string& payload) {
  return bytes_of("LC02" + kNumber + channel + '\0' + payload);
}

// Fragment `number` of 2 of a message of 100,000 bytes.
Bytes fragment(char number, const std::string& rest) {
  return bytes_of("LC03" + kNumber + std::string("\0\x01\x86\xa0\0\0\0\0\0", 9) + number + std::string("\0\2", 2) +
                  rest);
}

}  // namespace

TEST_CASE("A short LCM message is parsed into channel and payload") {
  const Bytes bytes = short_message("CONTACTS", "abc");
  const auto m = parse_datagram(bytes);
  REQUIRE(m);
  CHECK(m->channel == "CONTACTS");
  CHECK(Bytes(m->data.begin(), m->data.end()) == bytes_of("abc"));
  CHECK(m->complete);
  CHECK(m->fits());

  SECTION("the payload may be empty") {
    const Bytes empty = short_message("A", "");
    REQUIRE(parse_datagram(empty));
    CHECK(parse_datagram(empty)->data.empty());
  }
  SECTION("a payload above 1400 bytes does not fit the bus") {
    const Bytes longest = short_message("A", std::string(channels::kMaxMessageBytes, 'x'));
    const Bytes longer = short_message("A", std::string(channels::kMaxMessageBytes + 1, 'x'));
    CHECK(parse_datagram(longest)->fits());
    CHECK_FALSE(parse_datagram(longer)->fits());
  }
}

TEST_CASE("Only the first fragment of a long message is parsed, and it does not fit") {
  const Bytes first = fragment(0, std::string("BIG\0abc", 7));
  const auto m = parse_datagram(first);
  REQUIRE(m);
  CHECK(m->channel == "BIG");
  CHECK_FALSE(m->complete);
  CHECK_FALSE(m->fits());
  const Bytes second = fragment(1, "BIG and more");
  CHECK_FALSE(parse_datagram(second));
}

TEST_CASE("Datagrams that are not valid LCM are rejected") {
  const auto nothing = [](const Bytes& b) { return !parse_datagram(b); };
  CHECK(nothing({}));
  CHECK(nothing(bytes_of("LC02")));
  CHECK(nothing(bytes_of("LC02" + kNumber)));
  CHECK(nothing(bytes_of("LC02" + kNumber + "NO_END")));
  CHECK(nothing(short_message("", "no channel")));
  CHECK(nothing(short_message(std::string(kMaxChannelBytes + 1, 'C'), "")));
  CHECK_FALSE(nothing(short_message(std::string(kMaxChannelBytes, 'C'), "")));
  CHECK(nothing(bytes_of("LC04" + kNumber + std::string("A\0", 2))));
}

TEST_CASE("Parsed channel and payload lie within the datagram for random bytes") {
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes(random() % 64);
    for (auto& b : bytes) b = random() % 4 == 0 ? 0 : static_cast<std::uint8_t>(random());
    const std::string magic = random() % 2 == 0 ? "LC02" : "LC03";
    std::copy_n(magic.begin(), std::min(magic.size(), bytes.size()), bytes.begin());
    const auto m = parse_datagram(bytes);
    if (!m) continue;
    const auto* begin = reinterpret_cast<const char*>(bytes.data());
    REQUIRE(m->channel.data() >= begin);
    REQUIRE(m->data.data() + m->data.size() == bytes.data() + bytes.size());
    REQUIRE(m->channel.find('\0') == std::string_view::npos);
  }
}
