#include "audio_node/devices/file_card.h"

#include <fcntl.h>
#include <sndfile.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "audio_node/mixer/sound_writer.h"

namespace tactus::audio {
namespace {

// An existing path that is not a regular file, such as /dev/null, is written directly.
std::string part_path(const std::string& wav) {
  std::error_code ignored;
  const bool plain = !std::filesystem::exists(wav, ignored) || std::filesystem::is_regular_file(wav, ignored);
  return plain ? wav + ".part" : wav;
}

}  // namespace

FileCard::FileCard(const StreamOptions& options, const std::string& wav, Render render)
    : wav_(wav),
      part_(part_path(wav)),
      render_(std::move(render)),
      rate_Hz_(options.rate_Hz),
      period_frames_(options.period_frames),
      latency_(sync::from_seconds(options.latency_periods * options.period_frames / options.rate_Hz)),
      block_(static_cast<std::size_t>(options.period_frames * options.channels)),
      file_(nullptr, sf_close) {
  // When two programs render into one file, the second is rejected. The lock ends with its process.
  lock_ = open(part_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ >= 0 && part_ != wav_ && flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(std::exchange(lock_, -1));
    throw std::runtime_error("another program is writing " + part_ + "; choose another --wav");
  }
  SF_INFO info{};
  info.samplerate = options.rate_Hz;
  info.channels = options.channels;
  info.format = kFloatWav;
  try {
    file_.reset(open_for_writing(part_, info, "--wav"));
  } catch (...) {
    if (lock_ >= 0) close(lock_);
    throw;
  }
  // The peak chunk holds the time of day, which would make two equal runs differ.
  sf_command(file_.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
}

FileCard::~FileCard() {
  file_.reset();
  std::error_code ignored;
  if (!finished_ && part_ != wav_) std::filesystem::remove(part_, ignored);
  if (lock_ >= 0) close(lock_);
}

void FileCard::finish() {
  if (std::exchange(finished_, true)) return;
  std::error_code error;
  const bool closed = sf_close(file_.release()) == 0;
  if (closed && part_ != wav_) std::filesystem::rename(part_, wav_, error);
  if (closed && !error) return;
  finished_ = false;
  throw std::runtime_error("cannot finish " + wav_ + " (" + (closed ? error.message() : "the file cannot be closed") +
                           "); free some disk space or choose another --wav");
}

sync::HostTime FileCard::presentation_time(std::int64_t frame) const {
  const std::int64_t seconds = frame / rate_Hz_, rest = frame % rate_Hz_;
  return *start_ + sync::Nanoseconds(seconds * 1'000'000'000 + rest * 1'000'000'000 / rate_Hz_);
}

void FileCard::play_until(sync::HostTime now) {
  if (!start_) start_ = now;
  while (presentation_time(frames()) <= now + latency_) {
    const sync::HostTime first = presentation_time(frames());
    if (frames() >= next_pair_frame_) {
      pair_ = {frames(), sync::to_ns(first), frames() == 0 ? MediaPair::kStart : MediaPair::kPeriodic, 0};
      next_pair_frame_ += rate_Hz_;
    }
    // The rendering time depends on the machine and is not passed on, so the quality is full, or that of the
    // setting.
    render_(block_.data(), period_frames_, {first, sync::Nanoseconds(0), sync::Nanoseconds(0)});
    if (sf_writef_float(file_.get(), block_.data(), period_frames_) != period_frames_)
      throw std::runtime_error("cannot continue to write " + wav_ + " (" + write_error(file_.get()) +
                               "); free some disk space or choose another --wav");
    ++blocks_;
  }
}

std::optional<MediaPair> FileCard::next_pair() { return std::exchange(pair_, std::nullopt); }

}  // namespace tactus::audio
