// What lies under PortAudio: which sound cards this machine has, and how it is given a virtual one.
#pragma once

#include <string>

namespace tactus::audio {

// Whether ALSA knows a card, or a sound server of this user listens.
bool has_sound_card();

// Keeps ALSA and JACK from printing on stderr what is no news (no card, no server) and JACK from starting a
// server.
void silence_sound_libraries();

// A configuration of ALSA in which the virtual card is the only one. It lives in memory: nothing is left behind.
class VirtualCard {
 public:
  static constexpr const char* kName = "vcard";
  // The plug-in lies beside the program. Throws std::runtime_error with one sentence.
  VirtualCard(const std::string& wav_path, int rate_Hz, int channels, int pairs_fd);
  ~VirtualCard();
  VirtualCard(const VirtualCard&) = delete;
  VirtualCard& operator=(const VirtualCard&) = delete;

 private:
  int config_fd_ = -1;
};

}  // namespace tactus::audio
