#include "visual_node/video/recording.h"

#include <filesystem>
#include <mutex>
#include <optional>

#include "visual_node/video/encoder.h"
#include "visual_node/video/i420.h"
#include "visual_node/video/png.h"

namespace tactus::visual {

struct Recording::Shared {
  mutable std::mutex mutex;
  std::string error;
};

namespace {

// Runs in the writing thread: fills the slots of one file.
class VideoWriter {
 public:
  VideoWriter(std::vector<std::string> command, int width, int height, std::function<void(std::string)> report)
      : command_(std::move(command)), width_(width), height_(height), report_(std::move(report)) {}

  bool write(const Picture& picture) {
    if (!encoder_ && !start()) return false;
    const auto repeats = slots_.repeats_before(picture.tick);
    if (!repeats) return true;
    for (std::int64_t i = 0; i < *repeats; ++i)
      if (!encoder_->write(planes_)) return lost();
    planes_.resize(i420_bytes(width_, height_));
    rgba_to_i420(picture.rgba, width_, height_, planes_);
    return encoder_->write(planes_) || lost();
  }
  void end() { encoder_.reset(); }

 private:
  bool start() {
    try {
      encoder_.emplace(command_);
      return true;
    } catch (const std::exception& e) {
      report_(e.what());
      return false;
    }
  }
  bool lost() {
    report_("the video ends early: its encoder has died");
    return false;
  }
  std::vector<std::string> command_;
  int width_, height_;
  std::function<void(std::string)> report_;
  std::optional<Encoder> encoder_;
  SlotFiller slots_;
  std::vector<std::uint8_t> planes_;
};

constexpr std::size_t kSnapshotQueue = 2;

}  // namespace

std::string next_video_path(const std::string& folder, const std::string& name) {
  const std::filesystem::path out(folder);
  std::filesystem::path file = out / (name + ".mp4");
  for (int n = 2; std::filesystem::exists(file); ++n) file = out / (name + "." + std::to_string(n) + ".mp4");
  return file.string();
}

Recording::Recording(RecordingOptions options)
    : options_(std::move(options)), shared_(std::make_shared<Shared>()) {}
Recording::~Recording() = default;

void Recording::begin(int width, int height, const Settings& settings) {
  const auto bytes = static_cast<std::size_t>(width * height * 4);
  if (video_) ending_ = std::jthread([old = std::move(video_)]() mutable { old.reset(); });
  snapshots_.reset();
  if (!options_.snapshot.empty())
    snapshots_ = std::make_unique<FrameSink>(kSnapshotQueue, bytes,
                                             [file = options_.snapshot, width, height](const Picture& p) {
                                               return write_png(file, p.rgba, width, height);
                                             });
  if (!options_.video) return;
  file_ = next_video_path(options_.folder, options_.name);
  clock_.emplace();
  const auto report = [shared = shared_](std::string text) {
    const std::lock_guard lock(shared->mutex);
    shared->error = std::move(text);
  };
  auto writer = std::make_shared<VideoWriter>(
      encoder_command(file_, width, height, settings.rate_Hz, settings.video_crf), width, height, report);
  video_ = std::make_unique<FrameSink>(
      static_cast<std::size_t>(settings.video_queue), bytes,
      [writer](const Picture& p) { return writer->write(p); }, [writer] { writer->end(); });
}

std::optional<media_clock_t> Recording::add(std::int64_t tick, sync::HostTime fence,
                                            const std::function<void(std::span<std::uint8_t>)>& read) {
  const auto offer = [&](FrameSink& sink) {
    auto picture = sink.take_empty();
    if (!picture) return false;
    picture->tick = tick;
    read(picture->rgba);
    sink.push(std::move(*picture));
    return true;
  };
  if (snapshots_ && fence >= next_snapshot_) {
    next_snapshot_ = fence + sync::from_seconds(options_.snapshot_every_s);
    offer(*snapshots_);
  }
  if (!video_ || video_->ended()) return std::nullopt;
  if (!offer(*video_)) return ++dropped_, std::nullopt;
  const SlotClock::Pair pair = clock_->frame(tick);
  media_clock_t m{};
  m.header.sim_time_ns = -1;
  m.medium = std::filesystem::path(file_).filename().string();
  m.index = pair.index;
  m.host_time_ns = sync::to_ns(fence);
  m.reason = pair.reason;
  return m;
}

std::string Recording::error() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->error;
}

std::string Recording::status_text() const {
  if (const std::string why = error(); !why.empty()) return why;
  return dropped_ > 0 ? "the encoder was too busy for " + std::to_string(dropped_) + " pictures of the video" : "";
}

}  // namespace tactus::visual
