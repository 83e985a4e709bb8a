#include "visual_node/scene_view/flashes.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/vectors.h"

namespace tactus::visual {
namespace {

// A hit at this speed flashes with full strength; slower hits are weaker by the square root, so that a light touch
// is also visible.
constexpr float kFullSpeed_m_s = 1.0f;
constexpr float kMinStrength = 0.35f;
// Initial share of the radius of a flash.
constexpr float kFirstSize = 0.45f;
// Warm for a hit, cool for a begin; they differ in lightness too, for colour-blind users.
const Eigen::Vector3f kHit{1.0f, 0.62f, 0.18f}, kBegin{0.35f, 0.75f, 1.0f};

Glow disc(const Eigen::Vector3f& centre, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
          const Eigen::Vector3f& colour, float growth) {
  Glow g;
  g.centre << centre, growth;
  g.u << u, 0;
  g.v << v, 0;
  g.colour << colour, 0;
  return g;
}

}  // namespace

Flashes::Flashes(const Settings& s)
    : duration_(sync::from_seconds(s.flash_duration_s)),
      min_frames_(s.flash_frames),
      radius_m_(static_cast<float>(s.flash_radius_m)),
      min_px_(static_cast<float>(s.flash_pixels)) {}

void Flashes::add(const contact_event_t& event, sync::HostTime t) { flashes_.push_back({event, t, 0}); }

void Flashes::append_glows(const Flash& f, sync::HostTime t, const Camera& camera, std::vector<Glow>& out) const {
  const float age =
      std::clamp(static_cast<float>((t - f.first).count()) / static_cast<float>(duration_.count()), 0.0f, 1.0f);
  const float grown = kFirstSize + (1 - kFirstSize) * std::sqrt(age);
  const Eigen::Vector3f centre = camera.about_origin(to_eigen(f.event.point_m));
  const float distance_m = std::max((centre - camera.eye).norm(), 1e-3f);
  const float radius_m = grown * std::max(radius_m_, min_px_ * distance_m / camera.focal_px);
  const float speed = std::clamp(std::sqrt(f.event.approach_speed_m_s / kFullSpeed_m_s), kMinStrength, 1.0f);
  // The last of the minimum frames stays visible after the duration.
  const Eigen::Vector3f colour =
      (f.event.kind == contact_event_t::HIT ? kHit : kBegin) * speed * std::max(1 - age, 0.15f);

  // A ring in the plane of contact, and a core that faces the eye: one of them is visible from any side.
  const Eigen::Vector3f normal = to_eigen(f.event.normal).cast<float>();
  const Eigen::Vector3f u = normal.unitOrthogonal();
  out.push_back(disc(centre, radius_m * u, radius_m * normal.cross(u), colour, age));
  const Eigen::Vector3f right = camera.view.block<1, 3>(0, 0).transpose(),
                        up = camera.view.block<1, 3>(1, 0).transpose();
  out.push_back(disc(centre, 0.6f * radius_m * right, 0.6f * radius_m * up, colour, -1));
}

std::vector<Glow> Flashes::frame(sync::HostTime t, const Camera& camera) {
  std::erase_if(flashes_, [&](const Flash& f) { return f.frames >= min_frames_ && t - f.first >= duration_; });
  std::vector<Glow> glows;
  for (auto f = flashes_.rbegin(); f != flashes_.rend(); ++f) {
    append_glows(*f, t, camera, glows);
    ++f->frames;
  }
  return glows;
}

std::vector<std::int64_t> Flashes::shown() const {
  std::vector<std::int64_t> ids;
  for (auto f = flashes_.rbegin(); f != flashes_.rend(); ++f) ids.push_back(f->event.event_id);
  return ids;
}

}  // namespace tactus::visual
