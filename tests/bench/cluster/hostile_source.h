// Hostile messages for any channel: damaged ones, which every border must refuse, and valid ones with false senders, times,
// numbers and values. Its models are messages of the running cluster and random valid messages. Pure: one seed, one sequence.
#pragma once

#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/lcmtypes/schema.h"

namespace tactus::bench {

using Bytes = std::vector<std::uint8_t>;

enum class Hostility {
  kMalformed,     // truncated, too long, of another type, not finite, false counts and enumerations: refused at the border
  kOtherRun,      // valid values of a sender of another run
  kSecondSender,  // of the own run, another incarnation
  kForged         // with the identity of the genuine sender
};

struct HostileChannel {
  const char* name;
  std::string type;
  std::function<Bytes(unsigned seed)> sample;       // a random valid message
  std::function<bool(const Bytes&)> accepted;       // whether a border accepts the bytes
};
// Every channel of lcmtypes/channels.h.
const std::vector<HostileChannel>& hostile_channels();
const HostileChannel& hostile_channel(std::string_view name);

class HostileSource {
 public:
  // run_id, clock: of the cluster.
  HostileSource(Hostility kind, std::int64_t run_id, std::int32_t clock, unsigned seed);

  // A genuine message of the cluster, as a model.
  void observe(std::string_view channel, std::span<const std::uint8_t> data);
  // The next message for that channel, at this time of the cluster's clock.
  Bytes next(const HostileChannel& channel, std::int64_t now_ns);

 private:
  struct Model {
    Bytes bytes;
    std::vector<test::Spot> spots;
  };
  struct Models {
    std::vector<Model> models;
    Bytes newest;  // genuine; empty: none yet
  };
  Model model(const HostileChannel& channel, Bytes bytes) const;
  Models& models(const HostileChannel& channel);
  std::size_t below(std::size_t n) { return random_() % n; }
  template <class List>
  auto one_of(const List& list) { return list[below(std::size(list))]; }
  std::int64_t any_id() { return 1 + static_cast<std::int64_t>(random_() >> 2); }
  Bytes damaged(const HostileChannel& channel, const Model& of);
  void falsify_header(Bytes& bytes, const Bytes& newest, std::int64_t now_ns);
  void falsify_values(Bytes& bytes, const std::vector<test::Spot>& spots);
  void falsify(Bytes& bytes, const test::Spot& spot);

  Hostility kind_;
  std::int64_t run_id_;
  std::int32_t clock_;
  std::mt19937_64 random_;
  test::Schema schema_;
  std::map<std::string, Models, std::less<>> models_;
  std::int64_t sent_ = 0;
};

}  // namespace tactus::bench
