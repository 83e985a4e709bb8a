#include "sync/clock_sync/pair_probe.h"

#include <algorithm>
#include <array>

namespace tactus::sync {
namespace {

constexpr std::array<std::uint8_t, 4> kPairMagic{'T', 'P', 'P', '1'};
// A round never has more: the limit keeps a forged number from filling the memory or spoiling a share.
constexpr std::uint64_t kMaxNumbers = 1 << 20;
constexpr std::int64_t kMaxTime_ns = std::int64_t{1} << 60;

void put(std::vector<std::uint8_t>& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void put(std::vector<std::uint8_t>& out, const std::string& name) {
  const std::size_t size = std::min(name.size(), PairDatagram::kMaxName);
  out.push_back(static_cast<std::uint8_t>(size));
  for (std::size_t i = 0; i < PairDatagram::kMaxName; ++i)
    out.push_back(i < size ? static_cast<std::uint8_t>(name[i]) : 0);
}

struct Reader {
  std::span<const std::uint8_t> data;
  std::uint64_t number(int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | data[static_cast<std::size_t>(i)];
    data = data.subspan(static_cast<std::size_t>(bytes));
    return value;
  }
  std::string name() {
    const std::size_t size = std::min<std::size_t>(number(1), PairDatagram::kMaxName);
    std::string text(reinterpret_cast<const char*>(data.data()), size);
    data = data.subspan(PairDatagram::kMaxName);
    return text;
  }
};

}  // namespace

std::vector<std::uint8_t> PairDatagram::encode(std::size_t size) const {
  std::vector<std::uint8_t> out(kPairMagic.begin(), kPairMagic.end());
  put(out, run, 8);
  put(out, kind, 1);
  put(out, number, 8);
  put(out, from);
  put(out, to);
  for (const std::int64_t t : {sent_ns, received_ns, replied_ns}) put(out, static_cast<std::uint64_t>(t), 8);
  out.resize(std::clamp(size, kMinBytes, kMaxBytes));
  return out;
}

std::optional<PairDatagram> PairDatagram::decode(std::span<const std::uint8_t> data) {
  if (data.size() < kMinBytes || data.size() > kMaxBytes) return std::nullopt;
  if (!std::equal(kPairMagic.begin(), kPairMagic.end(), data.begin())) return std::nullopt;
  Reader r{data.subspan(kPairMagic.size())};
  PairDatagram m;
  m.run = r.number(8);
  const std::uint64_t kind = r.number(1);
  if (kind < kRequest || kind > kEnd) return std::nullopt;
  m.kind = static_cast<Kind>(kind);
  m.number = r.number(8);
  m.from = r.name();
  m.to = r.name();
  for (std::int64_t* t : {&m.sent_ns, &m.received_ns, &m.replied_ns}) {
    *t = static_cast<std::int64_t>(r.number(8));
    if (*t < 0 || *t > kMaxTime_ns) return std::nullopt;
  }
  if (m.number >= kMaxNumbers) return std::nullopt;
  return m;
}

void PairRecord::on_message(const PairDatagram& m, int ttl) {
  if (ttl >= 0) ttl_ = ttl;
  if (m.kind == PairDatagram::kRequest) requests_.insert(m.number), sent_ = std::max(sent_, m.number + 1);
  if (m.kind == PairDatagram::kBurst) bursts_.insert(m.number);
  if (m.kind == PairDatagram::kEnd) sent_ = std::max(sent_, m.number);
}

void PairRecord::on_reply(const PairDatagram& m, HostTime at) {
  const std::int64_t remote_ns = m.replied_ns - m.received_ns;
  const std::int64_t round_trip_ns = to_ns(at) - m.sent_ns - remote_ns;
  if (remote_ns < 0 || round_trip_ns < 0) return;  // negative durations are impossible: forged
  round_trips_.push_back(Nanoseconds(round_trip_ns));
  if (Nanoseconds(round_trip_ns) >= min_round_trip_) return;
  min_round_trip_ = Nanoseconds(round_trip_ns);
  // Cristian's and NTP's estimate (RFC 5905, section 8): accurate to half the round trip.
  offset_ = Nanoseconds((m.received_ns - m.sent_ns) / 2 + (m.replied_ns - to_ns(at)) / 2);
}

double PairRecord::lost() const {
  if (requests_.empty()) return 1.0;
  return 1.0 - static_cast<double>(requests_.size()) / static_cast<double>(sent_ - *requests_.begin());
}

Nanoseconds PairRecord::round_trip(double share) const {
  if (round_trips_.empty()) return Nanoseconds(-1);
  std::vector<Nanoseconds> sorted = round_trips_;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
}

}  // namespace tactus::sync
