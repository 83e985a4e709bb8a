// The sound system below PortAudio: detection of sound cards, and the configuration of the virtual card.
#pragma once

#include <string>

namespace tactus::audio {

// True when ALSA has a card, or a sound server of this user is running.
bool has_sound_card();

// Suppresses messages of ALSA and JACK on stderr about missing cards and servers, and keeps JACK from starting a
// server.
void silence_sound_libraries();

// A configuration of ALSA in which the virtual card is the only one. It exists in memory only, so no file remains.
class VirtualCard {
 public:
  static constexpr const char* kName = "vcard";
  // The plug-in is in the folder of the program. Throws std::runtime_error with one sentence.
  VirtualCard(const std::string& wav_path, int rate_Hz, int channels, int pairs_fd);
  ~VirtualCard();
  VirtualCard(const VirtualCard&) = delete;
  VirtualCard& operator=(const VirtualCard&) = delete;

 private:
  int config_fd_ = -1;
};

}  // namespace tactus::audio
