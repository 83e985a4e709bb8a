#include "sync/text/pattern.h"

#include <catch2/catch.hpp>
#include <stdexcept>

using tactus::sync::Pattern;

TEST_CASE("A pattern selects the names that it matches as a whole") {
  const Pattern contacts("CONTACT.*|WORLD_STATE");
  CHECK(contacts.matches("CONTACT_EVENTS"));
  CHECK(contacts.matches("WORLD_STATE"));
  CHECK_FALSE(contacts.matches("MY_CONTACTS"));
  CHECK_FALSE(contacts.matches("WORLD_STATE_2"));
  const Pattern copy = contacts;
  CHECK(copy.matches("CONTACTS"));
  CHECK_FALSE(Pattern("").matches("x"));
}

TEST_CASE("A text that is not a regular expression is refused") {
  for (const char* wrong : {"(", "[A-", "*", "A{2"}) {
    INFO(wrong);
    CHECK_THROWS_AS(Pattern(wrong), std::invalid_argument);
  }
}
