#include "sim_node/command/commander.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "lcmtypes/vectors.h"
#include "sim_node/command/properties.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kLongestText = 512;  // of a sim_reply_t
constexpr std::size_t kMaxAnswers = 256;  // in one tick; the sender repeats

std::string at(sync::SimTime t) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << sync::to_seconds(t.time_since_epoch()) << " s";
  return text.str();
}

}  // namespace

void Commander::take(const sim_command_t& c) {
  if (waiting_ && waiting_->id == c.id) return;
  const auto before =
      std::find_if(known_.begin(), known_.end(), [&](const sim_reply_t& r) { return r.id == c.id; });
  if (before != known_.end()) {
    if (answers_.size() < kMaxAnswers) answers_.push_back(*before);
    return;
  }
  std::string text;
  const std::string refused = carry_out(c, text);
  if (waiting_ && waiting_->id == c.id) return;
  answer(c.id, refused, text);
}

std::string Commander::carry_out(const sim_command_t& c, std::string& text) {
  switch (c.kind) {
    case sim_command_t::PAUSE:
      paused_ = true;
      steps_left_ = 0;
      text = "the world stands still at " + at(simulation_.now());
      return "";
    case sim_command_t::RESUME:
      paused_ = false;
      steps_left_ = 0;
      text = "the world goes on at " + at(simulation_.now());
      return "";
    case sim_command_t::STEP:
      if (!paused_) return "the world runs; pause it before you take single steps";
      if (c.steps < 1) return "a number of steps of 1 or more is needed";
      steps_left_ += c.steps;
      text =
          std::to_string(c.steps) + (c.steps == 1 ? " step" : " steps") + " from " + at(simulation_.now()) + " on";
      return "";
    case sim_command_t::RESET:
      simulation_.reset();
      steps_left_ = 0;
      anew_ = true;
      text = "the world is as at its first instant";
      return "";
    case sim_command_t::SET:
      text = c.name + "." + c.property + " is set from " + at(simulation_.now()) + " on";
      return set_property(simulation_, world_, c.name, c.property, c.values);
    case sim_command_t::PUSH:
      text = c.name + " is pushed from " + at(simulation_.now()) + " on";
      return push_body(simulation_, world_, c.name, to_eigen(c.force_N), to_eigen(c.torque_N_m),
                       sync::Nanoseconds(c.duration_ns));
    case sim_command_t::SNAPSHOT: return snapshot(c, text);
    case sim_command_t::RESTORE: return restore(c, text);
    default: return "this command is not known";
  }
}

std::string Commander::snapshot(const sim_command_t& c, std::string& text) {
  if (!StateStore::good_name(c.name)) return "a name of letters, digits, \"_\" and \"-\" is needed, at most 64";
  if (c.to_file && store_.busy()) return "another state is being written or read; ask again";
  StateStore::Bytes bytes = simulation_.save();
  text = "\"" + c.name + "\" is the world at " + at(simulation_.now()) + ", " + std::to_string(bytes.size()) +
         " bytes";
  if (!store_.keep(c.name, std::move(bytes)))
    return "as many states are kept as there may be, " + std::to_string(StateStore::kMax) +
           "; use one of their names again";
  if (!c.to_file) return "";
  store_.begin_write(c.name);
  waiting_ = Waiting{c.id, false, c.name, text + ", and in " + store_.file_of(c.name).string()};
  return "";
}

std::string Commander::restore(const sim_command_t& c, std::string& text) {
  if (!StateStore::good_name(c.name)) return "a name of letters, digits, \"_\" and \"-\" is needed, at most 64";
  if (const StateStore::Bytes* kept = store_.find(c.name)) return put_back(*kept, c.name, text);
  if (store_.busy()) return "another state is being written or read; ask again";
  store_.begin_read(c.name);
  waiting_ = Waiting{c.id, true, c.name, ""};
  return "";
}

std::string Commander::put_back(std::span<const std::uint8_t> bytes, const std::string& name, std::string& text) {
  const std::string refused = simulation_.restore(bytes);
  if (!refused.empty()) return "\"" + name + "\" cannot be put back: " + refused;
  steps_left_ = 0;
  anew_ = true;
  text = "the world is as at \"" + name + "\", " + at(simulation_.now());
  return "";
}

void Commander::answer(std::int64_t id, const std::string& refused, const std::string& text) {
  sim_reply_t r{};
  r.id = id;
  r.done = refused.empty() ? 1 : 0;
  r.text = (refused.empty() ? text : refused).substr(0, kLongestText);
  r.paused = paused_ ? 1 : 0;
  known_.push_back(r);
  if (known_.size() > kRemembered) known_.pop_front();
  if (answers_.size() < kMaxAnswers) answers_.push_back(std::move(r));
}

std::vector<sim_reply_t>& Commander::answers() {
  if (auto done = store_.poll(); done && waiting_) {
    std::string text = waiting_->text, refused = done->refused;
    if (waiting_->reads && refused.empty()) refused = put_back(done->bytes, waiting_->name, text);
    answer(std::exchange(waiting_, std::nullopt)->id, refused, text);
  }
  out_.clear();
  std::swap(out_, answers_);
  return out_;
}

bool Commander::step_due() {
  if (!paused_) return true;
  if (steps_left_ == 0) return false;
  --steps_left_;
  return true;
}

}  // namespace tactus::sim
