// The contacts that slide or roll just now: the force of each on its two bodies, sample by sample. Pure.
//
// A tip that slides over a profile is pushed up and down by its slope, as a phonograph's needle, stronger with the
// root of the power that friction takes (van den Doel, Kry and Pai 2001, "FoleyAutomatic", sections 4.1 and 4.2).
// What rolls feels the same profile through a low-pass, since the patch that touches is wider than the finest
// waves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audio_node/signal/butterworth.h"
#include "audio_node/excitation/scrape.h"
#include "audio_node/mixer/voices.h"

namespace tactus::audio {

class Scrapes {
 public:
  static constexpr int kMax = kMaxScrapes;
  // Each drives a body twice at the most, while its place on it goes from one set of gains to the next.
  static_assert(2 * kMax <= Voices::kDrives);

  explicit Scrapes(double rate_Hz) : rate_Hz_(rate_Hz) {}

  // One that is to be heard from its instant on. Realtime-safe: yes.
  void take(const Scrape& scrape);
  // Drives their bodies for the `frames` <= kMaxBlock frames that are rendered next, the first of which is heard
  // at `first`. The forces stay where they are until the next call. Realtime-safe: yes.
  void drive(Voices& voices, int frames, sync::HostTime first);
  int active() const;
  // Number of the oldest scrape that it holds, and whose relief it may still read. Realtime-safe: yes.
  std::optional<std::int64_t> oldest() const;
  void clear() { contacts_ = {}; }

  // Force of a contact in the block that was driven last, N s a sample scaled to full scale per Pa; null: no such.
  const float* force(std::int64_t id) const;

 private:
  using Block = std::array<float, kMaxBlock>;
  // Goes from where it is to where it is told to be within so many samples, to the bit.
  struct Ramp {
    float value = 0, target = 0;
    int left = 0;
    void go(float to, int within) {
      if (to != target) target = to, left = within;
    }
    float next();
  };
  struct Side {
    Eigen::Vector3d place_m, step_m;  // of the sample that comes next
    // Those in use, and those that they go to within a block or were before.
    std::array<PerMode, 2> gains;
    std::size_t in_use = 0;
    bool changed = false;  // told since
    Butterworth beyond;
    Block direct{};  // what its modes beyond those that are rendered sound
  };
  struct Contact {
    Scrape now;
    bool on = false, fresh = true;
    sync::HostTime heard{};  // of the newest
    Ramp slide, roll;
    Butterworth patch;
    std::array<Side, 2> sides;
    Block force{}, out{}, in{};
  };
  void begin(Contact& contact, const Scrape& scrape) const;
  Track follow(const ScrapeSide& told, Side& side, double since_s, bool fresh, int frames) const;
  void render(Contact& contact, int frames, sync::HostTime first) const;
  static void drive(Contact& contact, std::size_t side, Voices& voices, int frames);

  double rate_Hz_;
  std::array<Contact, kMax> contacts_;
};

}  // namespace tactus::audio
