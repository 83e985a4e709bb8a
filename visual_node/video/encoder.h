// An ffmpeg process that encodes raw pictures to a video file.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::visual {

// The command that encodes I420 pictures from its standard input: H.264 in a fragmented MP4. Its fragments of half
// a second are complete once written, so the file stays readable when a process is killed.
std::vector<std::string> encoder_command(const std::string& file, int width, int height, double rate_Hz, int crf);

class Encoder {
 public:
  // Starts the process with normal scheduling and nice 10. Throws std::runtime_error with one sentence when it
  // cannot start.
  explicit Encoder(const std::vector<std::string>& command);
  // Closes its input and waits for the end of the file; ends a process that does nothing for 10 s.
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // Blocks while the encoder is busy. False when it has died; the process must ignore SIGPIPE, as sync::Node
  // does.
  bool write(std::span<const std::uint8_t> bytes);
  // Closes its input and waits without limit until the file is finished. Returns true on success. Call nothing
  // after it.
  bool finish();

 private:
  int pipe_ = -1;
  pid_t child_ = -1;
};

}  // namespace tactus::visual
