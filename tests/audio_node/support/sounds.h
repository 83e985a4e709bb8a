// Small databases of recordings in a temporary folder, which the destructor removes.
#pragma once

#include <sndfile.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace tactus::audio::test {

class SoundFolder {
 public:
  SoundFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sounds_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~SoundFolder() { std::filesystem::remove_all(path_); }
  SoundFolder(const SoundFolder&) = delete;
  SoundFolder& operator=(const SoundFolder&) = delete;

  std::string path() const { return path_.string(); }

  // file: within the folder, such as "oak-steel/impact/1.wav".
  std::string place(const std::string& file) const {
    std::filesystem::create_directories((path_ / file).parent_path());
    return (path_ / file).string();
  }
  void write(const std::string& file, const std::vector<float>& x, int rate_Hz = 48000, int channels = 1) const {
    SF_INFO info{};
    info.samplerate = rate_Hz, info.channels = channels;
    info.format = file.ends_with(".flac") ? SF_FORMAT_FLAC | SF_FORMAT_PCM_24 : SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    SNDFILE* f = sf_open(place(file).c_str(), SFM_WRITE, &info);
    if (!f) throw std::runtime_error(file);
    sf_writef_float(f, x.data(), static_cast<sf_count_t>(x.size()) / channels);
    sf_close(f);
  }
  void text(const std::string& file, const std::string& what) const { std::ofstream(place(file)) << what; }

 private:
  std::filesystem::path path_;
};

inline std::vector<float> tone(double frequency_Hz, double length_s, double level = 0.5, double rate_Hz = 48000,
                               double decay_1_s = 0) {
  std::vector<float> x(static_cast<std::size_t>(length_s * rate_Hz));
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double t = static_cast<double>(n) / rate_Hz;
    x[n] =
        static_cast<float>(level * std::exp(-decay_1_s * t) * std::cos(2 * std::numbers::pi * frequency_Hz * t));
  }
  return x;
}

}  // namespace tactus::audio::test
