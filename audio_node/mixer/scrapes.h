// The contacts that currently slide or roll: the force of each on its two bodies, sample by sample. Pure.
//
// The slope of the profile pushes a sliding tip up and down, as a phonograph needle, with the root of the friction
// power (van den Doel, Kry and Pai 2001, "FoleyAutomatic", sections 4.1 and 4.2). Rolling uses the same profile
// through a low-pass, since the contact patch is wider than the finest waves.
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
  // Each contact drives a body at most twice, while its place moves from one set of gains to the next.
  static_assert(2 * kMax <= Voices::kDrives);

  explicit Scrapes(double rate_Hz) : rate_Hz_(rate_Hz) {}

  // Takes a scrape that is due. Realtime-safe: yes.
  void update(const Scrape& scrape);
  // Computes the forces of the frames offset .. offset + frames - 1 <= kMaxBlock - 1 of a block, the first of which is presented at
  // `first`. A block is computed in pieces that begin where scrapes fall due: the path of a contact then depends on its scrapes alone,
  // and not on the instants of the blocks. Realtime-safe: yes.
  void render(int offset, int frames, sync::HostTime first);
  // Drives the bodies with the forces of a block of `frames`, whose pieces have been computed. The forces remain valid until the next
  // call of render(). Realtime-safe: yes.
  void drive(Voices& voices, int frames);
  int active() const;
  // Number of the oldest scrape that it holds, and whose relief it may still read. Realtime-safe: yes.
  std::optional<std::int64_t> oldest() const;
  // Silences all at once. Realtime-safe: yes.
  void clear() {
    for (Contact& contact : contacts_) contact.on = false;
  }

  // Force of a contact in the last driven block, N s a sample scaled to full scale per Pa; null: no such contact.
  const float* force(std::int64_t id) const;

 private:
  using Block = std::array<float, kMaxBlock>;
  // Reaches its target exactly, within a given number of samples.
  struct Ramp {
    float value = 0, target = 0;
    int left = 0;
    void set_target(float to, int within) {
      if (to != target) target = to, left = within;
    }
    float next();
  };
  struct Side {
    Eigen::Vector3d place_m, step_m;  // of the next sample
    // The step changes evenly to the target step within this number of samples: the time until the next scrape.
    Eigen::Vector3d target_step_m;
    int to_target = 0;
    // The set in use, and the set of the next or previous block.
    std::array<PerMode, 2> gains;
    std::size_t in_use = 0;
    bool changed = false;  // new gains have arrived
    Butterworth residual;
    Block direct{};  // sound of its modes beyond the rendered ones
  };
  struct Contact {
    Scrape now;
    bool on = false, fresh = true, updated = true;
    bool ended = false;  // silent from the next block on
    sync::HostTime updated_at{};  // presentation time of the newest scrape
    Ramp slide, roll;
    Butterworth patch;
    std::array<Side, 2> sides;
    Block force{}, out{}, in{};
  };
  int frames_of(double interval_s) const;
  void begin(Contact& contact, const Scrape& scrape) const;
  void aim(const ScrapeSide& received, Side& side, double since_s, double interval_s, bool fresh) const;
  Track follow(const ScrapeSide& received, Side& side, int frames, int interval) const;
  void render(Contact& contact, int offset, int frames, sync::HostTime first) const;
  static void drive(Contact& contact, std::size_t side, Voices& voices, int frames);

  double rate_Hz_;
  std::array<Contact, kMax> contacts_;
};

}  // namespace tactus::audio
