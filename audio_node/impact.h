// Turns a contact event into a strike: contact time, impulse, loudness, direction. Pure.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <tactus/contact_event_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/body_sound.h"
#include "audio_node/strike.h"

namespace tactus::audio {

// Duration of an elastic impact of a ball, s: T = 2.87 (m^2 / (R E*^2 v))^(1/5) (Hertz 1882; Johnson, Contact
// Mechanics, 1985, eq. 11.24), with 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b.
double contact_time_s(double effective_mass_kg, double curvature_1_m, double speed_m_s, const Elastic& a,
                      const Elastic& b);

// Magnitude of the spectrum of a raised-cosine pulse of unit area and length T at a frequency.
double pulse_spectrum(double frequency_Hz, double length_s);

// Gains of two loudspeakers for a source: 1/r, and equal power by its azimuth. The listener looks along +x, z up.
struct StereoGain {
  double left, right;
};
StereoGain stereo_gain(const Eigen::Isometry3d& T_W_listener, const Eigen::Vector3d& source_m, double nearest_m);

// The sounding bodies of one scene.
class Impacts {
 public:
  // mesh: the extent of the mesh asset of that hash. generation: other scenes get other voices, so that old ones
  // ring out.
  Impacts(const scene_t& scene, const std::function<std::optional<Extent>(std::int64_t)>& mesh,
          const Settings& settings, double rate_Hz, std::int64_t generation);

  // T_world_listener from the next strike on; at first the scene's.
  void hear_from(const Eigen::Isometry3d& listener) { listener_ = listener; }

  // Bodies or materials that the scene does not have sound as small wooden ones.
  Strike strike(const contact_event_t& event, sync::HostTime scheduled) const;

  const BodySound& body(int id) const;

 private:
  struct Voice {
    BodySound sound;
    Resonators resonators;
  };
  const Voice& voice(int id) const;
  Elastic material(int index) const;
  double peak_Pa(const Voice& voice, double impulse_N_s, double length_s) const;
  double click_Pa(const BodySound& sound, double impulse_N_s, double length_s) const;

  Settings settings_;
  double rate_Hz_;
  std::int64_t generation_;
  Eigen::Isometry3d listener_;
  std::vector<Elastic> materials_;
  std::vector<Voice> voices_;
  Voice unknown_;
};

}  // namespace tactus::audio
