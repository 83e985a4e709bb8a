#include "sim_node/command/commander.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "lcmtypes/utf8.h"
#include "lcmtypes/vectors.h"
#include "sim_node/command/properties.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxText = 512;  // limit of sim_reply_t
constexpr std::size_t kMaxReplies = 256;  // per tick; the sender repeats

std::string at(sync::SimTime t) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << sync::to_seconds(t.time_since_epoch()) << " s";
  return text.str();
}

}  // namespace

void Commander::execute(const sim_command_t& c) {
  if (pending_ && pending_->id == c.id) return;
  const auto before =
      std::find_if(past_replies_.begin(), past_replies_.end(), [&](const sim_reply_t& r) { return r.id == c.id; });
  if (before != past_replies_.end()) {
    if (replies_.size() < kMaxReplies) replies_.push_back(*before);
    return;
  }
  std::string text;
  const std::string error = run_command(c, text);
  if (pending_ && pending_->id == c.id) return;
  reply(c.id, error, text);
}

std::string Commander::run_command(const sim_command_t& c, std::string& text) {
  switch (c.kind) {
    case sim_command_t::PAUSE:
      paused_ = true;
      steps_left_ = 0;
      text = "the world is paused at " + at(simulation_.now());
      return "";
    case sim_command_t::RESUME:
      paused_ = false;
      steps_left_ = 0;
      text = "the world resumes at " + at(simulation_.now());
      return "";
    case sim_command_t::STEP:
      if (!paused_) return "the world runs; pause it before you take single steps";
      if (c.steps < 1) return "the number of steps must be 1 or more";
      steps_left_ += c.steps;
      text =
          std::to_string(c.steps) + (c.steps == 1 ? " step" : " steps") + " from " + at(simulation_.now()) + " on";
      return "";
    case sim_command_t::RESET:
      simulation_.reset();
      steps_left_ = 0;
      restarted_ = true;
      text = "the world is reset to its first instant";
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
    default: return "unknown command";
  }
}

std::string Commander::snapshot(const sim_command_t& c, std::string& text) {
  if (!StateStore::valid_name(c.name)) return "the name must have 1 to 64 letters, digits, \"_\" or \"-\"";
  if (c.to_file && store_.busy()) return "another state is being written or read; repeat the command";
  StateStore::Bytes bytes = simulation_.save();
  text = "\"" + c.name + "\" is the world at " + at(simulation_.now()) + ", " + std::to_string(bytes.size()) +
         " bytes";
  if (!store_.add(c.name, std::move(bytes)))
    return std::to_string(StateStore::kMax) + " states are stored, the maximum; use one of their names again";
  if (!c.to_file) return "";
  store_.begin_write(c.name);
  pending_ = PendingFile{c.id, false, c.name, text + ", also in the file " + store_.file_of(c.name).string()};
  return "";
}

std::string Commander::restore(const sim_command_t& c, std::string& text) {
  if (!StateStore::valid_name(c.name)) return "the name must have 1 to 64 letters, digits, \"_\" or \"-\"";
  if (const StateStore::Bytes* kept = store_.find(c.name)) return restore_bytes(*kept, c.name, text);
  if (store_.busy()) return "another state is being written or read; repeat the command";
  store_.begin_read(c.name);
  pending_ = PendingFile{c.id, true, c.name, ""};
  return "";
}

std::string Commander::restore_bytes(std::span<const std::uint8_t> bytes, const std::string& name, std::string& text) {
  const std::string error = simulation_.restore(bytes);
  if (!error.empty()) return "\"" + name + "\" cannot be restored: " + error;
  steps_left_ = 0;
  restarted_ = true;
  text = "the world is restored to \"" + name + "\", " + at(simulation_.now());
  return "";
}

void Commander::reply(std::int64_t id, const std::string& error, const std::string& text) {
  sim_reply_t r{};
  r.id = id;
  r.done = error.empty() ? 1 : 0;
  r.text = first_bytes(error.empty() ? text : error, kMaxText);
  r.paused = paused_ ? 1 : 0;
  past_replies_.push_back(r);
  if (past_replies_.size() > kMaxPastReplies) past_replies_.pop_front();
  if (replies_.size() < kMaxReplies) replies_.push_back(std::move(r));
}

std::vector<sim_reply_t>& Commander::take_replies() {
  if (auto done = store_.poll(); done && pending_) {
    std::string text = pending_->text, error = done->error;
    if (pending_->reads && error.empty()) error = restore_bytes(done->bytes, pending_->name, text);
    reply(std::exchange(pending_, std::nullopt)->id, error, text);
  }
  out_.clear();
  std::swap(out_, replies_);
  return out_;
}

bool Commander::step_due() {
  if (!paused_) return true;
  if (steps_left_ == 0) return false;
  --steps_left_;
  return true;
}

}  // namespace tactus::sim
