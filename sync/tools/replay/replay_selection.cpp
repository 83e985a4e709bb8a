#include "sync/tools/replay/replay_selection.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "sync/bus/datagram.h"
#include "sync/bus/identity.h"
#include "sync/log/log_header.h"
#include "sync/log/recorder_types.h"
#include "sync/text/printable.h"

namespace tactus::sync {
namespace {

using namespace channels;
constexpr std::array kWithheld{
    kNodeHealth,   kPresented,      kSyncReport,   kClockProbe,    kClockMap,      kMediaClock,   kFrameShown,
    kPlayout,      kPlayoutRequest, kDegradation,  kDegraded,      kSimCommand,    kSimReply,     kSetting,
    kSettingReply, kDeviceForce,    kThermalState, kThermalDevice, kSceneManifest, kAssetRequest, kAssetChunk,
    kPictureChunk, kLogInfo,        kLogTypes,     kTagRequest,    kQuestion,
    kAnswer,       "LCM_SELF_TEST"};
// A log of random bytes has too many channels to remember.
constexpr std::size_t kMaxDecided = 4096;

std::optional<Pattern> expression(const char* option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  try {
    return Pattern(text);
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(std::string(option) + " " + text +
                             ": is not a regular expression; write for example 'CONTACT.*|WORLD_STATE'");
  }
}

}  // namespace

ReplaySelection::ReplaySelection(const ReplaySelectionOptions& w)
    : verbatim_(w.verbatim),
      as_recorded_(w.as_recorded),
      channels_(expression("--channels", w.channels)),
      leave_out_(expression("--leave-out", w.leave_out)),
      also_(expression("--also", w.also)) {
  for (const std::string& word : w.rename) {
    const std::size_t at = word.find('=');
    const std::string to = at == std::string::npos ? "" : word.substr(at + 1);
    if (at == 0 || !is_legal_channel(to))
      throw std::runtime_error("--rename " + printable(word) + ": write it as FROM=TO, two names of channels of at most " +
                               std::to_string(kMaxChannelBytes) + " bytes");
    rename_.emplace_back(word.substr(0, at), to);
  }
  for (const std::string& node : w.live) live_.insert(static_cast<std::int32_t>(fnv1a_32(node)));
}

const ReplaySelection::Channel& ReplaySelection::decide(std::string_view recorded) {
  if (const auto it = decided_.find(recorded); it != decided_.end()) return it->second;
  const std::string name(recorded);
  const auto matches = [&](const std::optional<Pattern>& e) { return e && e->matches(name); };
  Channel c{true, name};
  if (!verbatim_ && !matches(also_)) {
    const bool withheld =
        std::any_of(kWithheld.begin(), kWithheld.end(), [&](const char* w) { return recorded == w; });
    c.sent = !withheld || (as_recorded_ && recorded == kDegradation);
  }
  if (channels_ && !matches(channels_)) c.sent = false;
  if (matches(leave_out_)) c.sent = false;
  for (const auto& [from, to] : rename_)
    if (recorded == from) c.name = to;
  if (decided_.size() < kMaxDecided) return decided_.emplace(name, std::move(c)).first->second;
  return scratch_ = std::move(c);
}

std::optional<std::string_view> ReplaySelection::channel_of(const LogEvent& event) {
  const Channel& c = decide(event.channel);
  if (!c.sent) return std::nullopt;
  if (!verbatim_ && !live_.empty())
    if (const auto header = peek_header(event.data.data(), event.data.size());
        header && live_.contains(header->source))
      return std::nullopt;
  return c.name;
}

}  // namespace tactus::sync
