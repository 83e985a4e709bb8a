#include "sync/bus/receive_buffer.h"

#include <linux/capability.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>

using namespace tactus::sync;

namespace {

// Rights of the calling thread, and their effect on sockets.
struct Found {
  std::uint32_t held = 0;
  int buffer_bytes = 0;  // of a socket that was opened before
  bool can_force = false;
  std::uint32_t of_new_thread = 0;
};

std::uint32_t permitted() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct held[_LINUX_CAPABILITY_U32S_3]{};
  syscall(SYS_capget, &header, held);
  return held[0].permitted | held[0].effective;
}

int buffer_of(int socket) {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;  // the kernel doubles the requested size
}

// In a process of its own, because the step is irreversible. dropped: the right is given up after the socket is open.
Found in_process(bool dropped) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    Found found;
    const int opened = socket(AF_INET, SOCK_DGRAM, 0), later = socket(AF_INET, SOCK_DGRAM, 0);
    request_receive_buffer(opened);
    if (dropped && !drop_receive_buffer_right()) _exit(2);
    if (dropped && !drop_receive_buffer_right()) _exit(3);  // twice is no fault
    found.held = permitted();
    found.buffer_bytes = buffer_of(opened);
    found.can_force = setsockopt(later, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBufferBytes, sizeof kReceiveBufferBytes) == 0;
    std::thread([&] { found.of_new_thread = permitted(); }).join();
    if (write(ends[1], &found, sizeof found) != sizeof found) _exit(4);
    _exit(0);
  }
  close(ends[1]);
  Found found;
  CHECK(read(ends[0], &found, sizeof found) == sizeof found);
  close(ends[0]);
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  return found;
}

}  // namespace

TEST_CASE("The right to large receive buffers is given up, other rights and open sockets keep theirs") {
  constexpr std::uint32_t kRight = 1u << CAP_NET_ADMIN;
  const Found with = in_process(false), without = in_process(true);
  CHECK(without.held == (with.held & ~kRight));
  CHECK(without.of_new_thread == without.held);
  CHECK(without.buffer_bytes == with.buffer_bytes);
  CHECK_FALSE(without.can_force);
  if (with.can_force) CHECK(without.buffer_bytes >= kReceiveBufferBytes);
  int limit = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit;
  if (!(with.held & kRight) && limit > 0) CHECK(without.buffer_bytes == std::min(limit, kReceiveBufferBytes));
}
