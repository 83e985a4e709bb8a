#include "sync/relay/decimator.h"

#include <cmath>
#include <tactus/contact_frame_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/decode.h"
#include "sync/degradation/degraded_snapshots.h"
#include "sync/relay/motion_line.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kSeqAt = 8 + 8 + 8 + 4 + 8 + 4 + 8;  // LCM's fingerprint and header_t before its last member

// Big-endian, as LCM encodes.
void number(std::vector<std::uint8_t>& message, std::int64_t seq) {
  for (std::size_t i = 0; i < 8; ++i)
    message[kSeqAt + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(seq) >> (56 - 8 * i));
}

bool in_pages(const std::string& channel) {
  return channel == channels::kContacts || channel == channels::kWorldState || channel == channels::kTouchModel;
}

}  // namespace

template <class Message>
class Decimator::Compared : public Comparison {
 public:
  explicit Compared(const Rule& rule) : stack_({"", 1, {rule}}, rule.modality, SimTime{}) {}

  void push(std::span<const std::uint8_t> message, HostTime arrival,
            std::vector<std::vector<std::uint8_t>>& out) override {
    auto m = decode<Message>(message.data(), message.size());
    if (!m) return;
    stream_.push(std::move(*m), arrival, stack_, nullptr);
    while (const auto next = stream_.pop(arrival)) out.push_back(encode(next->first));
  }

 private:
  OperatorChain stack_;
  DegradedSnapshots<Message> stream_;
};

// The motion of a hand, whose receiver publishes it again.
class Decimator::Motion : public Comparison {
 public:
  explicit Motion(const DeadbandDef& deadband) : sender_(deadband) {}
  void push(std::span<const std::uint8_t> message, HostTime arrival, std::vector<std::vector<std::uint8_t>>& out) override {
    const auto m = decode<tool_state_t>(message.data(), message.size());
    if (m && sender_.send(*m, arrival)) out.emplace_back(message.begin(), message.end());
  }

 private:
  MotionSender sender_;
};

Decimator::Decimator(const PassRule& rule) : rule_(rule) {}
Decimator::~Decimator() = default;
Decimator::Decimator(Decimator&&) noexcept = default;

std::unique_ptr<Decimator::Comparison> Decimator::comparison() const {
  Rule rule = rule_.thinning;
  if (!in_pages(rule_.channel)) rule.rate.reset();  // decided on before, by due()
  if (!rule.rate && !rule.deadband) return nullptr;
  if (carries_motion(rule_)) return std::make_unique<Motion>(*rule.deadband);
  if (rule_.channel == channels::kContacts) return std::make_unique<Compared<contact_frame_t>>(rule);
  if (rule_.channel == channels::kWorldState) return std::make_unique<Compared<world_state_t>>(rule);
  if (rule_.channel == channels::kTouchModel) return std::make_unique<Compared<touch_model_t>>(rule);
  return std::make_unique<Compared<tool_state_t>>(rule);
}

// Keeps the mean rate: a message that comes a little early need not wait for a whole period more.
bool Decimator::due(Sender& s, const header_t& h, HostTime arrival) const {
  if (!rule_.thinning.rate || in_pages(rule_.channel)) return true;
  const std::int64_t before_ns = s.newest.has_one() ? s.newest.header().publish_time_ns : h.publish_time_ns;
  if (s.newest.is_old(h, arrival)) return false;
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / rule_.thinning.rate->rate_Hz));
  if (h.publish_time_ns < before_ns) s.next_ns = h.publish_time_ns;  // the time before was wrong
  if (h.publish_time_ns < s.next_ns) return false;
  s.next_ns = std::max(s.next_ns + period_ns, h.publish_time_ns);
  return true;
}

void Decimator::push(const header_t& h, std::span<const std::uint8_t> message, HostTime arrival, const Out& out) {
  if (!rule_.decimates()) return out(message);
  if (senders_.size() >= kMaxSenders && !senders_.contains(h.source)) senders_.clear();
  Sender& sender = senders_[h.source];
  if (sender.incarnation != h.incarnation) {
    sender = {};
    sender.incarnation = h.incarnation;
    sender.comparison = comparison();
  }
  if (!due(sender, h, arrival)) return;
  passing_.clear();
  if (!sender.comparison)
    passing_.emplace_back(message.begin(), message.end());
  else
    sender.comparison->push(message, arrival, passing_);
  for (auto& bytes : passing_) {
    number(bytes, sender.next_seq++);
    out(bytes);
  }
}

}  // namespace tactus::sync
