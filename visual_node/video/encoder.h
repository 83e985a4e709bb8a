// An ffmpeg process that turns raw pictures into a video file.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::visual {

// The command that encodes I420 pictures from its standard input: H.264 in a fragmented MP4, whose fragments of
// half a second are complete as they are written, so that a process killed at any moment leaves a readable file.
std::vector<std::string> encoder_command(const std::string& file, int width, int height, double rate_Hz, int crf);

class Encoder {
 public:
  // Starts it with normal scheduling and nice 10. Throws std::runtime_error with one sentence when there is none.
  explicit Encoder(const std::vector<std::string>& command);
  // Closes its input and waits until it has finished the file, a few seconds at most, then ends it.
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // Blocks while the encoder is busy. False when it has died; the process must ignore SIGPIPE, as sync::Node does.
  bool write(std::span<const std::uint8_t> bytes);
  // Closes its input and waits until it has finished the file, however long that takes. True: it succeeded. Then it is over.
  bool finish();

 private:
  int pipe_ = -1;
  pid_t child_ = -1;
};

}  // namespace tactus::visual
