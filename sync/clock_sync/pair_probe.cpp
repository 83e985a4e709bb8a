#include "sync/clock_sync/pair_probe.h"

#include <algorithm>
#include <cstring>

namespace tactus::sync {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'T', 'P', 'P', '1'};
// A round never has more: the limit keeps a forged number from filling the memory or spoiling a share.
constexpr std::uint64_t kMaxNumbers = 1 << 20;
constexpr std::int64_t kLatest = std::int64_t{1} << 60;

void put(std::vector<std::uint8_t>& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void put(std::vector<std::uint8_t>& out, const std::string& name) {
  const std::size_t size = std::min(name.size(), PairDatagram::kLongestName);
  out.push_back(static_cast<std::uint8_t>(size));
  for (std::size_t i = 0; i < PairDatagram::kLongestName; ++i)
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
    const std::size_t size = std::min<std::size_t>(number(1), PairDatagram::kLongestName);
    std::string text(reinterpret_cast<const char*>(data.data()), size);
    data = data.subspan(PairDatagram::kLongestName);
    return text;
  }
};

}  // namespace

std::vector<std::uint8_t> PairDatagram::encode(std::size_t size) const {
  std::vector<std::uint8_t> out(kMagic.begin(), kMagic.end());
  put(out, run, 8);
  put(out, kind, 1);
  put(out, number, 8);
  put(out, from);
  put(out, to);
  for (const std::int64_t t : {asked_ns, heard_ns, answered_ns}) put(out, static_cast<std::uint64_t>(t), 8);
  out.resize(std::clamp(size, kShortest, kLongest));
  return out;
}

std::optional<PairDatagram> PairDatagram::decode(std::span<const std::uint8_t> data) {
  if (data.size() < kShortest || data.size() > kLongest) return std::nullopt;
  if (!std::equal(kMagic.begin(), kMagic.end(), data.begin())) return std::nullopt;
  Reader r{data.subspan(kMagic.size())};
  PairDatagram m;
  m.run = r.number(8);
  const std::uint64_t kind = r.number(1);
  if (kind < kAsk || kind > kEnd) return std::nullopt;
  m.kind = static_cast<Kind>(kind);
  m.number = r.number(8);
  m.from = r.name();
  m.to = r.name();
  for (std::int64_t* t : {&m.asked_ns, &m.heard_ns, &m.answered_ns}) {
    *t = static_cast<std::int64_t>(r.number(8));
    if (*t < 0 || *t > kLatest) return std::nullopt;
  }
  if (m.number >= kMaxNumbers) return std::nullopt;
  return m;
}

void PairRecord::hear(const PairDatagram& m, int ttl) {
  if (ttl >= 0) ttl_ = ttl;
  if (m.kind == PairDatagram::kAsk) asked_.insert(m.number), sent_ = std::max(sent_, m.number + 1);
  if (m.kind == PairDatagram::kBurst) bursts_.insert(m.number);
  if (m.kind == PairDatagram::kEnd) sent_ = std::max(sent_, m.number);
}

void PairRecord::hear_answer(const PairDatagram& m, HostTime at) {
  const std::int64_t there = m.answered_ns - m.heard_ns;
  const std::int64_t round = to_ns(at) - m.asked_ns - there;
  if (there < 0 || round < 0) return;  // negative durations are impossible: forged
  round_trips_.push_back(Nanoseconds(round));
  if (Nanoseconds(round) >= best_) return;
  best_ = Nanoseconds(round);
  // Cristian's and NTP's estimate (RFC 5905, section 8): accurate to half the round trip.
  offset_ = Nanoseconds((m.heard_ns - m.asked_ns) / 2 + (m.answered_ns - to_ns(at)) / 2);
}

double PairRecord::lost() const {
  if (asked_.empty()) return 1.0;
  return 1.0 - static_cast<double>(asked_.size()) / static_cast<double>(sent_ - *asked_.begin());
}

Nanoseconds PairRecord::round_trip(double share) const {
  if (round_trips_.empty()) return Nanoseconds(-1);
  std::vector<Nanoseconds> sorted = round_trips_;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
}

}  // namespace tactus::sync
