// The receive buffer of a socket of the bus, and the right that it may need.
#pragma once

namespace tactus::sync {

// 4 MB: a burst of 20,000 datagrams of 100 bytes.
inline constexpr int kReceiveBufferBytes = 4 << 20;

// Requests it for a socket. Without CAP_NET_ADMIN the kernel limits it to net.core.rmem_max. Throws std::system_error when the
// socket takes no buffer.
void request_receive_buffer(int socket);

// Gives up CAP_NET_ADMIN for the calling thread and those that it starts: no message is read with a right that only opening a
// socket needs. Open sockets keep their buffers. Irreversible. Returns false when the kernel refuses.
bool drop_receive_buffer_right();

}  // namespace tactus::sync
