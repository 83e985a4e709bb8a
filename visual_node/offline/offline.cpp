#include "visual_node/offline/offline.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "visual_node/video/png.h"

namespace tactus::visual {

Offline::Offline(OfflineOptions options, double rate_Hz, sync::HostTime clock)
    : options_(std::move(options)), rate_Hz_(rate_Hz), feed_(options_.log, rate_Hz), began_(clock), said_(clock) {
  std::error_code none;
  for (const std::string& there : {options_.video, part_of(options_.video)})
    if (std::filesystem::exists(there, none))
      throw std::runtime_error(there + " exists and is not written over; remove it or choose another --video");
  // Also by another path or a link: a snapshot is written anew and anew.
  if (!options_.snapshot.empty() && std::filesystem::equivalent(options_.log, options_.snapshot, none))
    throw std::runtime_error(options_.snapshot +
                             " is the log itself, which would be lost; choose another --snapshot");
  if (!options_.as_recorded) feed_.leave_out(channels::kDegradation);
}

void Offline::adapt(sync::NodeOptions& options) const {
  options.bus = feed_.bus();
  options.run_id = feed_.run_id();
  options.realtime = "off";
  // That of the scene is a profile of the run too.
  if (!options_.as_recorded && options.degrade.empty()) options.profile = "<profile/>";
}

void Offline::begin(int width, int height, const Settings& s) {
  if (s.rate_Hz != rate_Hz_) {
    std::ostringstream text;
    text << "the scene of the log draws " << s.rate_Hz << " frames a second; give --set rate=" << s.rate_Hz;
    throw std::runtime_error(text.str());
  }
  if (!video_) {
    video_ = std::make_unique<VideoFile>(options_.video, width, height, s);
    rgba_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    next_snapshot_ = now_;
  }
  if (video_->width() != width || video_->height() != height)
    throw std::runtime_error(
        "the log changes the size of the picture midway; give it with --set width and height");
}

void Offline::add(const std::function<void(std::span<std::uint8_t>)>& read) {
  if (!video_) return;
  read(rgba_);
  video_->write(rgba_);
  if (options_.snapshot.empty() || now_ < next_snapshot_) return;
  next_snapshot_ = now_ + sync::from_seconds(options_.snapshot_every_s);
  if (!write_png(options_.snapshot, rgba_, video_->width(), video_->height()))
    throw std::runtime_error("cannot write " + options_.snapshot + "; choose another --snapshot");
}

std::optional<std::string> Offline::progress(sync::HostTime clock) {
  if (clock - said_ < sync::from_seconds(1)) return std::nullopt;
  said_ = clock;
  const double share = sync::to_seconds(now_ - feed_.begin()) / sync::to_seconds(feed_.end() - feed_.begin());
  return std::to_string(std::lround(100 * share)) + " % of the log";
}

std::string Offline::result(std::int64_t flashed, std::int64_t dropped, sync::HostTime clock) {
  if (!video_)
    throw std::runtime_error("the log has no scene; give one that scripts/run wrote from its beginning");
  video_->finish();
  const double film_s = static_cast<double>(video_->frames()) / rate_Hz_,
               took_s = sync::to_seconds(clock - began_);
  std::ostringstream text;
  text << options_.video << ": " << video_->frames() << " frames, " << film_s << " s, " << flashed << " flashes";
  if (dropped > 0) text << " (and " << dropped << " events not shown: too late)";
  text << ", in " << took_s << " s (" << film_s / took_s << " times as fast as time); pixels " << std::hex
       << video_->pixels() << std::dec;
  if (feed_.damaged_regions() > 0)
    text << "\nskipped damage of the log: " << feed_.damaged_regions() << " regions, " << feed_.damaged_bytes()
         << " bytes";
  if (feed_.misdated() > 0)
    text << "\n"
         << feed_.misdated()
         << " events bear damaged times, far from the others; they were taken with those before them";
  return text.str();
}

}  // namespace tactus::visual
