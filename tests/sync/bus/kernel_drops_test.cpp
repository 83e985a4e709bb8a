// Tests of the count of datagrams that the kernel dropped at our sockets.
#include "sync/bus/kernel_drops.h"

#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

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

TEST_CASE("Kernel drops are summed over the sockets of this process only") {
  CHECK(sum_drops(kTable, {"20001", "20003"}) == 15);
  CHECK(sum_drops(kTable, {"20002"}) == 500);
  CHECK(sum_drops(kTable, {}) == 0);
}

TEST_CASE("An empty or truncated socket table counts zero drops") {
  CHECK(sum_drops("", {"20001"}) == 0);
  CHECK(sum_drops("headings\n 1: a b c\n\n", {"20001"}) == 0);
}

TEST_CASE("Kernel drops of a new process are zero or unknown") {
  const std::int64_t drops = kernel_drops();
  CHECK((drops == 0 || drops == -1));
}

TEST_CASE("Packets dropped for lack of buffer space are counted, packets rejected by a socket filter are not") {
  const int to = socket(AF_INET, SOCK_DGRAM, 0), from = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(bind(to, reinterpret_cast<sockaddr*>(&at), sizeof at) == 0);
  socklen_t size = sizeof at;
  REQUIRE(getsockname(to, reinterpret_cast<sockaddr*>(&at), &size) == 0);
  const int least = 1;
  REQUIRE(setsockopt(to, SOL_SOCKET, SO_RCVBUF, &least, sizeof least) == 0);
  REQUIRE(connect(from, reinterpret_cast<sockaddr*>(&at), sizeof at) == 0);
  const char bytes[1000] = {};
  for (int i = 0; i < 50; ++i) send(from, bytes, sizeof bytes, 0);
  const std::int64_t without = kernel_drops();
  sock_filter nothing[] = {BPF_STMT(BPF_RET | BPF_K, 0)};
  const sock_fprog program{1, nothing};
  REQUIRE(setsockopt(to, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0);
  const std::int64_t with = kernel_drops();
  close(to), close(from);
  if (without < 0) return;  // the count is not available on this machine
  CHECK(without >= 40);
  CHECK(with == 0);
}
