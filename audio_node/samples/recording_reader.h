// Reads the recordings of one folder in a confined process, the program read_sounds (sync/sandbox/README.md): libsndfile and
// the libraries below it parse untrusted files.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "audio_node/samples/recording_file.h"
#include "sync/sandbox/readable_folders.h"
#include "sync/sandbox/reader_session.h"

namespace tactus::audio {

class RecordingReader {
 public:
  // folder: the reader can open the files below it, and no others. rate_Hz: sample rate of the results.
  RecordingReader(const std::string& folder, double rate_Hz);

  // The same as read_recording (recording_file.h), bit by bit, for a file below the folder that may be hostile. A link that leads
  // out of the folder is a fault. One thread only.
  std::optional<Recording> read(const std::string& path, Interaction interaction, std::vector<SoundFault>& faults);

 private:
  sync::ReadableFolders readable_;
  sync::ReaderSession session_;
  double rate_Hz_;
};

// The answer of read_sounds to a request. Faults have no path.
struct ReadSound {
  std::optional<Recording> recording;
  std::vector<SoundFault> faults;
};
std::vector<std::uint8_t> pack(const ReadSound& sound);
// Throws std::runtime_error with one clause when the answer is not valid: a hostile file may control its reader.
ReadSound unpack_sound(std::span<const std::uint8_t> answer, double rate_Hz);

// Reads the file of a request. Called by read_sounds.
std::vector<std::uint8_t> answer_request(std::span<const std::uint8_t> request);

}  // namespace tactus::audio
