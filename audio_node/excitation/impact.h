// Converts a contact event to a strike: contact time, impulse, place on both bodies, loudness, direction. Pure.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <tactus/contact_event_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/modal/body_sound.h"
#include "audio_node/excitation/strike.h"

namespace tactus::audio {

// Duration of an elastic impact of a ball, s: T = 2.87 (m^2 / (R E*^2 v))^(1/5) (Hertz 1882; Johnson, Contact
// Mechanics, 1985, eq. 11.24).
double contact_time_s(double effective_mass_kg, double curvature_1_m, double speed_m_s, const Elastic& a,
                      const Elastic& b);

// Position of a source relative to a listener who faces +x, z up; not nearer than nearest_m.
SourcePosition place_of(const Eigen::Isometry3d& T_W_listener, const Eigen::Vector3d& source_m, double nearest_m);

// T_world_body of a body at the time of an event; empty when it is not known.
using PoseOf = std::function<std::optional<Eigen::Isometry3d>(int body)>;

// The sounding bodies of one scene.
class Impacts {
 public:
  // mesh: extent of the mesh asset with that hash. generation: each scene has its own voices, so that the previous
  // ones decay.
  Impacts(const scene_t& scene, const std::function<std::optional<Extent>(std::int64_t)>& mesh,
          const Settings& settings, double rate_Hz, std::int64_t generation);

  // Factor on all strikes from the next one on.
  void set_gain(double gain) { settings_.gain = gain; }
  // T_world_listener from the next strike on; initially that of the scene.
  void set_listener(const Eigen::Isometry3d& listener) { listener_ = listener; }

  // The level is played_level() (signal/loudness.h) times the setting gain. The default recordings are rendered with this, so a
  // change of the level changes them too (mixer/make_sounds_main.cpp).
  // An implausible event gives an inaudible strike (plausible.h). Bodies or materials that the scene lacks sound
  // as small wooden ones. A body of unknown pose sounds as if struck at an average place.
  Strike strike(const contact_event_t& event, sync::HostTime scheduled, const PoseOf& pose = {}) const;

  const BodySound& body(int id) const { return voice(id).sound; }
  std::int64_t voice_id(int body) const { return generation_ << 32 | static_cast<std::uint32_t>(body); }
  const Resonators& resonators(int body) const { return (*resonators_)[voice(body).number]; }
  // Modes of all bodies; the sides of strikes point into it.
  const std::shared_ptr<const ResonatorTable>& table() const { return resonators_; }
  // Pressure at 1 m per impulse of each mode, Pa / (N s), for a force at that place; nothing: anywhere.
  PerMode gains(int body, const std::optional<BodyPlace>& place) const;
  // Converts a world point and direction to the frame of a body: by `pose`, or by the scene for a static body.
  std::optional<BodyPlace> place_on_body(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& direction,
                                   const PoseOf& pose) const;

 private:
  struct Voice {
    BodySound sound;
    std::size_t number = 0;  // in the table of resonators
    std::vector<double> radiated;             // of each mode: pressure at 1 m per impulse and Mode::gain
    std::optional<Eigen::Isometry3d> static_pose;  // T_world_body of a static body
  };
  const Voice& voice(int id) const;
  Elastic material(int index) const;
  double click_Pa(const BodySound& sound, double impulse_N_s, double length_s) const;
  ForcePulse pulse(const Voice& a, const Voice& b, double length_s) const;

  Settings settings_;
  double rate_Hz_;
  std::int64_t generation_;
  Eigen::Isometry3d listener_;
  std::vector<Elastic> materials_;
  std::vector<Voice> voices_;
  Voice unknown_;
  std::shared_ptr<const ResonatorTable> resonators_;
};

}  // namespace tactus::audio
