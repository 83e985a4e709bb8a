#include "sync/kernel_drops.h"

#include <catch2/catch.hpp>

using namespace tactus::sync;

namespace {
const char* const kTable =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref "
    "pointer drops\n"
    "  353: 434CFFEF:1DF3 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 20001 2 "
    "0000000000000000 12\n"
    "  354: 434CFFEF:1DF3 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 20002 2 "
    "0000000000000000 500\n"
    "  355: 434CFFEF:1DF4 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 20003 2 "
    "0000000000000000 3\n";
}

TEST_CASE("Drops are summed over our own sockets only") {
  CHECK(sum_drops(kTable, {"20001", "20003"}) == 15);
  CHECK(sum_drops(kTable, {"20002"}) == 500);
  CHECK(sum_drops(kTable, {}) == 0);
}

TEST_CASE("A table that is empty or cut off counts what it shows") {
  CHECK(sum_drops("", {"20001"}) == 0);
  CHECK(sum_drops("headings\n 1: a b c\n\n", {"20001"}) == 0);
}

TEST_CASE("This process has dropped nothing, or it is not known") {
  const std::int64_t drops = kernel_drops();
  CHECK((drops == 0 || drops == -1));
}
