#include "tests/bench/cluster/hostile_source.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tactus::bench {
namespace {

// Offsets of the fields of header_t, after the fingerprint of 8 bytes.
constexpr std::size_t kSimTime = 8, kPublishTime = 16, kClockId = 24, kRunId = 28, kIncarnation = 40, kSeq = 48, kHeaderEnd = 56;
constexpr std::size_t kModels = 32;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::int64_t number_at(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = (bytes.at(at) & 0x80) ? ~std::uint64_t{0} : 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes.at(at + i);
  return static_cast<std::int64_t>(value);
}

double real_at(const Bytes& bytes, const test::Spot& spot) {
  const std::size_t size = spot.type == "double" ? 8 : 4;
  std::array<unsigned char, 8> raw{};
  for (std::size_t i = 0; i < size; ++i) raw[i] = bytes.at(spot.offset + size - 1 - i);
  double wide = 0;
  float narrow = 0;
  if (size == 8) return __builtin_memcpy(&wide, raw.data(), 8), wide;
  return __builtin_memcpy(&narrow, raw.data(), 4), double{narrow};
}

void put_real(Bytes& bytes, const test::Spot& spot, double value) {
  spot.type == "double" ? test::put(bytes, spot.offset, value) : test::put(bytes, spot.offset, static_cast<float>(value));
}

std::size_t width(const test::Spot& spot) {
  return spot.type == "int8_t" || spot.type == "byte" ? 1 : spot.type == "int16_t" ? 2 : spot.type == "int32_t" || spot.type == "string" ? 4 : 8;
}

void put_whole(Bytes& bytes, const test::Spot& spot, std::int64_t value) {
  switch (width(spot)) {
    case 1: return test::put(bytes, spot.offset, static_cast<std::int8_t>(value));
    case 2: return test::put(bytes, spot.offset, static_cast<std::int16_t>(value));
    case 4: return test::put(bytes, spot.offset, static_cast<std::int32_t>(value));
    default: test::put(bytes, spot.offset, value);
  }
}

bool is_real(const test::Spot& spot) { return spot.type == "double" || spot.type == "float"; }

}  // namespace

HostileSource::HostileSource(Hostility kind, std::int64_t run_id, std::int32_t clock, unsigned seed)
    : kind_(kind), run_id_(run_id), clock_(clock), random_(seed), schema_(std::string(TACTUS_SOURCE_DIR) + "/lcmtypes") {}

HostileSource::Model HostileSource::model(const HostileChannel& channel, Bytes bytes) const {
  Model m{std::move(bytes), {}};
  m.spots = schema_.walk(channel.type, m.bytes);
  return m;
}

HostileSource::Models& HostileSource::models(const HostileChannel& channel) {
  Models& m = models_[channel.name];
  while (m.models.size() < kModels) m.models.push_back(model(channel, channel.sample(static_cast<unsigned>(random_()))));
  return m;
}

void HostileSource::observe(std::string_view name, std::span<const std::uint8_t> data) {
  const HostileChannel& channel = hostile_channel(name);
  Models& m = models(channel);
  m.newest.assign(data.begin(), data.end());
  // Every twentieth one replaces a model; a quarter of the models remain random messages.
  if (below(20) == 0 && channel.accepted(m.newest)) m.models[below(3 * kModels / 4)] = model(channel, m.newest);
}

Bytes HostileSource::next(const HostileChannel& channel, std::int64_t now_ns) {
  ++sent_;
  Models& all = models(channel);
  const Model& of = all.models[below(kModels)];
  if (kind_ == Hostility::kMalformed) return damaged(channel, of);
  Bytes bytes = of.bytes;
  falsify_header(bytes, all.newest, now_ns);
  falsify_values(bytes, of.spots);
  return bytes;
}

Bytes HostileSource::damaged(const HostileChannel& channel, const Model& of) {
  Bytes bytes = of.bytes;
  const test::Spot& spot = of.spots[below(of.spots.size())];
  switch (below(6)) {
    case 0:
      for (std::size_t i = 1 + below(64); i > 0; --i) bytes.push_back(static_cast<std::uint8_t>(random_()));
      break;
    case 1:
      bytes[below(8)] ^= static_cast<std::uint8_t>(1 + below(255));
      break;
    case 2:
      if (is_real(spot)) put_real(bytes, spot, below(2) ? kInfinity : std::numeric_limits<double>::quiet_NaN());
      break;
    case 3:
      if (!is_real(spot)) put_whole(bytes, spot, below(2) ? -1 : std::numeric_limits<std::int32_t>::max());
      break;
    case 4:
      for (std::size_t flips = 1 + below(8); flips > 0; --flips)
        bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1u << below(8));
      break;
    default: break;
  }
  // Damage that leaves a valid message is replaced by a truncation, which never does.
  if (channel.accepted(bytes)) bytes.resize(below(bytes.size()));
  return bytes;
}

void HostileSource::falsify_header(Bytes& bytes, const Bytes& newest, std::int64_t now_ns) {
  static constexpr std::int64_t kOffsets_ns[] = {0, 0, 0, 0, 1'000'000, -1'000'000, 100'000'000, -100'000'000, 10'000'000'000, -10'000'000'000};
  static constexpr std::int64_t kJumps[] = {1, 1, 1, 1, 2, 1000, 2'000'000, -5, 0, -1000};
  if (!newest.empty() && (kind_ == Hostility::kForged || below(2))) std::copy(newest.begin() + 8, newest.begin() + kHeaderEnd, bytes.begin() + 8);
  const std::int64_t sim_time_ns = number_at(bytes, kSimTime, 8);
  if (sim_time_ns >= 0) test::put(bytes, kSimTime, std::max<std::int64_t>(0, sim_time_ns + one_of(kOffsets_ns)));
  test::put(bytes, kPublishTime, std::max<std::int64_t>(0, now_ns + one_of(kOffsets_ns)));
  if (below(4)) test::put(bytes, kClockId, clock_);
  if (kind_ == Hostility::kForged) {
    test::put(bytes, kSeq, std::max<std::int64_t>(0, number_at(bytes, kSeq, 8) + one_of(kJumps)));
    if (newest.empty()) test::put(bytes, kRunId, run_id_);
    return;
  }
  test::put(bytes, kRunId, kind_ == Hostility::kSecondSender ? run_id_ : below(2) ? std::int64_t{1} : any_id());
  test::put(bytes, kIncarnation, below(4) ? static_cast<std::int64_t>(1 + below(3)) : any_id());
  test::put(bytes, kSeq, below(8) ? sent_ : static_cast<std::int64_t>(random_() >> 1));
}

void HostileSource::falsify_values(Bytes& bytes, const std::vector<test::Spot>& spots) {
  for (std::size_t changes = below(5); changes > 0; --changes) {
    const test::Spot& spot = spots[below(spots.size())];
    if (spot.offset >= kHeaderEnd && !spot.is_count && spot.type != "string") falsify(bytes, spot);
  }
  // Files that fill the disk are the business of the receiver's user, not of this test.
  for (const test::Spot& spot : spots)
    if (spot.path == "to_file") put_whole(bytes, spot, 0);
}

void HostileSource::falsify(Bytes& bytes, const test::Spot& spot) {
  static constexpr double kReals[] = {0, 1e-30, 1e-9, -1, 1, 1e3, -1e3, 9e8, -9e8, 1e38};
  if (is_real(spot)) {
    const double factor = std::uniform_real_distribution<double>(-3, 3)(random_);
    put_real(bytes, spot, below(3) ? real_at(bytes, spot) * factor : one_of(kReals));
    return;
  }
  const std::int64_t value = number_at(bytes, spot.offset, width(spot));
  put_whole(bytes, spot, below(2) ? value + static_cast<std::int64_t>(below(7)) - 3 : static_cast<std::int64_t>(random_() >> (1 + below(63))));
}

}  // namespace tactus::bench
