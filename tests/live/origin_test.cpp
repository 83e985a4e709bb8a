// Tests of the check of origin, host and token of a browser request.
#include "scripts/live/origin.h"

#include <catch2/catch.hpp>

using namespace tactus::live;

TEST_CASE("Only the served page, with its token, may connect to the server") {
  const Access access{8931, true, "0123456789abcdef"};
  CHECK(host_allowed("127.0.0.1:8931", access));
  CHECK(host_allowed("localhost:8931", access));
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8931", "127.0.0.1.evil.example:8931"})
    CHECK_FALSE(host_allowed(host, access));
  CHECK(origin_allowed("http://127.0.0.1:8931", "127.0.0.1:8931"));
  for (const char* origin : {"", "null", "http://evil.example", "https://127.0.0.1:8931", "http://localhost:8931"})
    CHECK_FALSE(origin_allowed(origin, "127.0.0.1:8931"));
  CHECK(token_matches("/ws?token=0123456789abcdef", access));
  for (const char* target : {"/ws", "/ws?token=", "/ws?token=0123456789abcdee", "/ws?token=0123456789abcdef0"})
    CHECK_FALSE(token_matches(target, access));
  CHECK_FALSE(token_matches("/ws?token=", Access{8931, true, ""}));
}
