// Arbitrary bytes as a datagram on the bus: rejected as no LCM datagram, or parsed into a channel and data that lie within them.
#include <cstdlib>

#include "sync/bus/datagram.h"
#include "sync/log/log_header.h"
#include "sync/bus/message_batch.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus::sync;
  const auto m = parse_datagram({data, size});
  if (!m) return 0;
  const auto* channel = reinterpret_cast<const std::uint8_t*>(m->channel.data());
  if (channel < data || channel + m->channel.size() > data + size || m->channel.size() > kMaxChannelBytes)
    std::abort();
  if (!m->data.empty() && (m->data.data() < data || m->data.data() + m->data.size() > data + size)) std::abort();
  if (const auto header = peek_header(m->data.data(), m->data.size()); header && header->run_id <= 0) std::abort();
  MessageBatch batch;
  if (batch.add(host_time(1), *m, 1 << 20) &&
      (batch[0].channel != m->channel || batch[0].data.size() != m->data.size()))
    std::abort();
  return 0;
}
