#include "audio_node/offline.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "audio_node/device/file_card.h"

namespace tactus::audio {

Offline::Offline(const std::string& log, std::string wav, double loop_rate_Hz, sync::HostTime clock)
    : feed_(log, loop_rate_Hz), wav_(std::move(wav)), began_(clock), said_(clock) {
  // Also by another path or a link.
  std::error_code none;
  for (const std::string& written : {wav_, wav_ + ".part"})
    if (std::filesystem::equivalent(log, written, none))
      throw std::runtime_error(written + " is the log itself, which would be lost; choose another --wav");
}

OpenCard Offline::open() {
  return [this](const StreamOptions& options, Card::Render render) {
    if (card_)
      throw std::runtime_error(
          "the log changes rate, period, ceiling, ears or instructions midway; give them with --set");
    auto made = std::make_unique<FileCard>(options, wav_, std::move(render));
    card_ = made.get();
    return made;
  };
}

std::optional<std::string> Offline::progress(sync::HostTime now, sync::HostTime clock) {
  if (clock - said_ < sync::from_seconds(1)) return std::nullopt;
  said_ = clock;
  const double share =
      sync::to_seconds(now - feed_.begin()) / sync::to_seconds(kRingOn + (feed_.end() - feed_.begin()));
  return std::to_string(std::lround(100 * share)) + " % of the log";
}

std::string Offline::result(double rate_Hz, std::int64_t hits, std::int64_t dropped, sync::HostTime clock) {
  if (!card_ || !card_->start())
    throw std::runtime_error("the log has no scene; give one that scripts/run wrote from its beginning");
  card_->finish();
  const double sound_s = static_cast<double>(card_->frames()) / rate_Hz, took_s = sync::to_seconds(clock - began_);
  std::ostringstream text;
  text << wav_ << ": " << sound_s << " s of sound, " << hits << " hits";
  if (dropped > 0) text << " (" << dropped << " of them not heard: too late, or silenced by a profile)";
  text << ", in " << took_s << " s (" << std::lround(sound_s / took_s)
       << " times as fast as time); its first sample was out at " << sync::to_ns(*card_->start()) << " ns";
  if (feed_.damaged_regions() > 0)
    text << "\nskipped damage of the log: " << feed_.damaged_regions() << " regions, " << feed_.damaged_bytes()
         << " bytes";
  if (feed_.misdated() > 0)
    text << "\n"
         << feed_.misdated()
         << " events bear damaged times, far from the others; they were heard with those before them";
  return text.str();
}

}  // namespace tactus::audio
