#include "visual_node/offline.h"

#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "visual_node/video/png.h"

namespace tactus::visual {

namespace {

// Files that may exist already and are overwritten.
std::vector<sync::OfflineInput::Written> overwritten_files(const OfflineOptions& options) {
  std::vector<sync::OfflineInput::Written> files;
  if (!options.snapshot.empty()) files.push_back({options.snapshot, "--snapshot"});
  if (!options.frames.empty()) files.push_back({options.frames, "--frames"});
  return files;
}

}  // namespace

void OfflineOptions::add_to(sync::Arguments& app) {
  sync::OfflineOptions::add_to(app, "draws this log of a run", "--video");
  app.add_option("--video", video, "file for the pictures of the log, MP4").needs("--log");
  app.add_option("--frames", frames,
                 "file for a table of the time and the pixel hash of each frame of the log, CSV").needs("--log");
  app.add_flag("--as-recorded", as_recorded, "the same as --degrade logged").needs("--log");
}

std::unique_ptr<Offline> Offline::open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock) {
  if (options.log.empty()) return nullptr;
  if (options.video.empty()) throw std::runtime_error("--log needs --video FILE, the file for the pictures");
  return std::make_unique<Offline>(options, rate_Hz, clock);
}

Offline::Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock)
    : options_(options), rate_Hz_(rate_Hz), run_(options, overwritten_files(options), rate_Hz, clock) {
  std::error_code ignored;
  for (const std::string& path : {options_.video, part_file_name(options_.video)})
    if (std::filesystem::exists(path, ignored))
      throw std::runtime_error(path + " exists and is not overwritten; remove it or choose another --video");
  if (options_.frames.empty()) return;
  frames_ = std::make_unique<sync::AtomicFile>(options_.frames, "--frames");
  frames_->write("frame,host_ns,pixels\n");
}

void Offline::begin(int width, int height, const Settings& s) {
  run_.require_rate(s.rate_Hz);
  if (!video_) {
    video_ = std::make_unique<VideoFile>(options_.video, width, height, s);
    rgba_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    next_snapshot_ = now();
  }
  if (video_->width() != width || video_->height() != height)
    throw std::runtime_error(
        "the log changes the size of the picture midway; give it with --set width and height");
}

void Offline::add(const std::function<void(std::span<std::uint8_t>)>& read) {
  if (!video_) return;
  read(rgba_);
  video_->write(rgba_);
  if (frames_) {
    std::ostringstream row;
    row << video_->frames() - 1 << ',' << sync::to_ns(now()) << ',' << std::hex << video_->newest_frame_hash()
        << '\n';
    frames_->write(row.str());
  }
  if (options_.snapshot.empty() || now() < next_snapshot_) return;
  next_snapshot_ = now() + sync::from_seconds(options_.snapshot_every_s);
  if (!write_png(options_.snapshot, rgba_, video_->width(), video_->height()))
    throw std::runtime_error("cannot write " + options_.snapshot + "; choose another --snapshot");
}

std::string Offline::result(std::int64_t flashed, std::int64_t dropped, sync::HostTime clock) {
  if (!video_) throw std::runtime_error(run_.no_scene());
  const double film_s = static_cast<double>(video_->frames()) / rate_Hz_;
  const std::string rest = run_.finish(film_s, clock);
  video_->finish();
  if (frames_) frames_->finish();
  std::ostringstream text;
  text << options_.video << ": " << video_->frames() << " frames, " << film_s << " s, " << flashed << " flashes";
  if (dropped > 0) text << " (and " << dropped << " events not shown: too late)";
  text << "; pixels " << std::hex << video_->pixel_hash() << std::dec << rest;
  return text.str();
}

}  // namespace tactus::visual
