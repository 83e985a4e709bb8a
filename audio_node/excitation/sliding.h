// Computes the sound of sliding and rolling contacts: place on both surfaces, speed, strength. Pure.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <tactus/contact_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>
#include <tactus/material_def_t.hpp>

#include "audio_node/excitation/contact_motion.h"
#include "audio_node/excitation/audio_surfaces.h"
#include "audio_node/excitation/impact.h"
#include "audio_node/excitation/scrape.h"
#include "audio_node/settings.gen.h"
#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"

namespace tactus::audio {

// Root of the friction power of a contact, W^(1/2).
double sliding_strength(double friction, double force_N, double speed_m_s);

// The contacts of one scene. A surface of a moving body is silent until its orientation is known.
class Sliding {
 public:
  // surfaces: of that scene, not null. bodies: orientation of moving bodies. bodies and impacts outlive this.
  Sliding(const scene_t& scene, std::shared_ptr<const AudioSurfaces> surfaces, const sync::BodyHistory& bodies,
          const Impacts& impacts, const Settings& settings, double rate_Hz);

  // Factor on all sound from the next instant on.
  void set_gain(double gain) { settings_.gain = gain; }
  // T_world_listener from the next contacts on; initially that of the scene.
  void set_listener(const Eigen::Isometry3d& listener) { listener_ = listener; }

  // Interval between updates: every tick, or the snapshot interval when there are many contacts, and at least the
  // interval of set_update_interval().
  double period_s() const { return std::max(period_s_, many_contacts_ ? kSnapshot_s : 0); }
  void set_update_interval(double period_s) { period_s_ = period_s; }
  // Scrapes of the contacts at instant t that are audible at `at`; each scrape that is no longer audible ends
  // once. dt_s: since the previous instant.
  const std::vector<Scrape>& scrapes(const sync::Contacts& contacts, sync::SimTime t, sync::HostTime at,
                                     double dt_s);

 private:
  static constexpr double kSnapshot_s = 1 / 60.;
  // One of the surfaces of a contact.
  struct ContactSurface {
    std::int32_t body = -1, material = -1;
    const AudioSurface* maps = nullptr;  // with a map
    std::optional<Eigen::Quaterniond> to_body;
  };
  struct ContactState {
    ContactMotion motion;
    bool present = false, audible = false;
    std::array<PerMode, 2> gains;
    std::array<double, 2> sliding_Pa_N{};       // of each body: rms pressure at 1 m per rms of a white force
    std::array<double, 2> residual_Pa_N{};      // the same for its modes beyond the rendered ones
    // the same for all modes, with a force filtered by the reference patch
    std::array<double, 2> rolling_Pa_N{};
    std::optional<Eigen::Vector3d> gains_point_m;  // place for which the gains hold, world
    double since_s = 0;                       // time since the gains were computed
  };
  // A contact with the strength of its sliding and rolling, N for a slope of 1.
  struct Candidate {
    const contact_t* contact;
    ContactState* state;
    std::array<ContactSurface, 2> surfaces;
    double friction, slide, roll, cutoff_Hz;
    double strength() const { return slide * slide + roll * roll; }
  };
  ContactSurface contact_surface(const contact_t& contact, std::size_t side, sync::SimTime t) const;
  std::optional<Candidate> candidate(const contact_t& contact, sync::SimTime t, double dt_s);
  Scrape scrape(const Candidate& candidate, sync::SimTime t, sync::HostTime at, double dt_s);
  ScrapeSide side(const Candidate& candidate, std::size_t side) const;
  void update_gains(const Candidate& candidate, sync::SimTime t, double dt_s) const;
  void estimate_loudness(const Candidate& candidate, std::size_t side) const;
  double imbalance_gain(const Candidate& candidate) const;
  // Contact patch of a rolling body with that force at that speed.
  struct Patch {
    double cutoff_Hz, force_N;
  };
  Patch patch(const contact_t& contact, double force_N, double speed_m_s, double rms_slope) const;
  double rms_slope(const std::array<ContactSurface, 2>& surfaces) const;
  Elastic elastic_of(std::int32_t material, std::int32_t body) const;

  Settings settings_;
  double rate_Hz_;
  Eigen::Isometry3d listener_;
  std::shared_ptr<const AudioSurfaces> surfaces_;
  const sync::BodyHistory& bodies_;
  const Impacts& impacts_;
  std::vector<material_def_t> materials_;
  std::vector<double> masses_kg_;                        // of moving bodies; 0: static or not known
  std::vector<double> curvatures_1_m_;                   // of round bodies; 0: flat or not known
  std::map<std::int32_t, Eigen::Quaterniond> static_orientations_;  // static bodies, which are rarely published
  std::map<std::int64_t, ContactState> contacts_;
  bool many_contacts_ = false;
  double period_s_ = 0;
  std::vector<Candidate> candidates_;
  std::vector<Scrape> out_;
};

}  // namespace tactus::audio
