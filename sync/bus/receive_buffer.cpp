#include "sync/bus/receive_buffer.h"

#include <linux/capability.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace tactus::sync {

void request_receive_buffer(int socket) {
  if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBufferBytes, sizeof kReceiveBufferBytes) == 0) return;
  if (setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes) < 0)
    throw std::system_error(errno, std::generic_category(), "SO_RCVBUF");
}

bool drop_receive_buffer_right() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct held[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, held) != 0) return false;
  constexpr auto kRight = ~(1u << CAP_NET_ADMIN);
  if (((held[0].permitted | held[0].effective | held[0].inheritable) & ~kRight) == 0) return true;
  held[0].permitted &= kRight, held[0].effective &= kRight, held[0].inheritable &= kRight;
  return syscall(SYS_capset, &header, held) == 0;
}

}  // namespace tactus::sync
