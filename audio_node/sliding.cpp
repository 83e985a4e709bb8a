#include "audio_node/sliding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "audio_node/plausible.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;

constexpr double kLeastSpeed_m_s = 1e-3;  // below, nothing scrapes (design)
// Beyond these nothing becomes louder or faster: no hand does so, and nothing on the bus shall.
constexpr double kMostSpeed_m_s = 5, kMostForce_N = 50;
// How a place goes over the map is looked at for so long: three snapshots at 60 Hz. Design.
constexpr double kLook_s = 0.05;
constexpr double kLeap = 3;  // times the way of the sliding (design)

// Of the pairs of points of a contact that which was heard before: bodies have several corners.
const contact_point_t& same_point(const contact_t& c, bool on_a, const std::optional<Vector3d>& before) {
  if (!before) return c.points[0];
  const auto far = [&](const contact_point_t& p) {
    return (to_eigen(on_a ? p.a_body_m : p.b_body_m) - *before).norm();
  };
  return *std::min_element(c.points.begin(), c.points.end(),
                           [&](const contact_point_t& p, const contact_point_t& q) { return far(p) < far(q); });
}

}  // namespace

Sliding::Sliding(const scene_t& scene, std::shared_ptr<const HeardSurfaces> surfaces,
                 const sync::BodyHistory& bodies, const Settings& settings)
    : settings_(settings), listener_(to_eigen(scene.listener)), surfaces_(std::move(surfaces)), bodies_(bodies) {
  for (const material_def_t& m : scene.materials) mu_.push_back(m.friction_dynamic);
  for (const body_def_t& b : scene.bodies)
    if (b.is_static) standing_[b.id] = to_eigen(b.pose.orientation);
}

// Nothing: it wears no map, or nobody has said yet how its body is turned.
std::optional<Sliding::Side> Sliding::side(const contact_t& c, bool is_a, sync::SimTime t) const {
  const std::int32_t material = is_a ? c.material_a : c.material_b, other = is_a ? c.material_b : c.material_a;
  const HeardSurface* surface = surfaces_->of(material);
  if (!surface) return std::nullopt;
  const auto mu = [&](std::int32_t m) {
    const auto i = static_cast<std::size_t>(m);
    return m >= 0 && i < mu_.size() ? mu_[i] : 1.0;  // one without a material: that of the other counts
  };
  const std::int32_t body = is_a ? c.body_a : c.body_b;
  if (const auto stands = standing_.find(body); stands != standing_.end())
    return Side{surface, stands->second.conjugate(), mu(material), mu(other), is_a};
  const auto pose = bodies_.pose(body, t);
  if (pose.how == sync::How::kNone) return std::nullopt;
  return Side{surface, pose.value.orientation.conjugate(), mu(material), mu(other), is_a};
}

// What of the sliding is a way over the map: all of it under a fingertip, nothing under an edge of the body
// itself, which stays where it is on the map.
double Sliding::share(Way& way, const Vector3d& place, const Vector3d& along) {
  // Between two snapshots a place is told again and again.
  if (way.place && place == *way.place && way.slid_s < kLook_s) return std::clamp(way.share, 0.0, 1.0);
  const double went_m = way.place ? (place - *way.place).dot(along) : way.slid_m;
  // Who leaps further is another corner, or was put there.
  if (std::abs(went_m) < kLeap * way.slid_m)
    way.share += (1 - std::exp(-way.slid_s / kLook_s)) * (went_m / way.slid_m - way.share);
  way.place = place;
  way.slid_m = way.slid_s = 0;
  return std::clamp(way.share, 0.0, 1.0);
}

const std::vector<Scrape>& Sliding::scrapes(const sync::Contacts& contacts, sync::SimTime t, sync::HostTime at,
                                            double dt_s) {
  out_.clear();
  dt_s = std::clamp(dt_s, 0.0, 0.1);
  for (auto& [id, way] : ways_) way.seen = false;
  for (const contact_t& c : contacts) {
    if (!plausible(c)) continue;
    const Vector3d past = to_eigen(c.sliding_velocity_m_s);  // of b past a
    const double speed = std::min(past.norm(), kMostSpeed_m_s);
    if (c.points.empty() || speed < kLeastSpeed_m_s) continue;
    auto worn = side(c, true, t);
    if (!worn) worn = side(c, false, t);
    if (!worn) continue;
    // How the other surface passes that which wears the map, in its body.
    const double sign = worn->is_a ? 1 : -1;
    const Vector3d along = worn->to_body * Vector3d(sign * past).normalized();
    const Vector3d outward = worn->to_body * Vector3d(sign * to_eigen(c.normal));
    Way& way = ways_[c.contact_id];
    way.seen = true;
    way.travelled_m += speed * dt_s, way.slid_m += speed * dt_s, way.slid_s += dt_s;
    const contact_point_t& point = same_point(c, worn->is_a, way.place);
    const Vector3d place = to_eigen(worn->is_a ? point.a_body_m : point.b_body_m);
    const Vector3d place_world = to_eigen(worn->is_a ? point.a_world_m : point.b_world_m);

    Scrape s;
    s.id = c.contact_id;
    s.at = at;
    s.travelled_m = way.travelled_m;
    s.speed_m_s = speed;
    double mu = std::sqrt(worn->mu * worn->other_mu);
    if (worn->surface->friction) mu *= pair_factor(worn->surface->friction->factor(outward, place));
    if (const Relief* relief = worn->surface->relief.get()) {
      const Vector3d over = share(way, place, along) * along;
      const BumpAxes axes = bump_axes(outward);
      const double size_u = static_cast<double>(relief->size_m.x()),
                   size_v = static_cast<double>(relief->size_m.y());
      s.relief = relief;
      s.u = place[axes.u] / size_u, s.v = place[axes.v] / size_v;
      s.along_u = over[axes.u], s.along_v = over[axes.v];
      s.u_per_s = speed * over[axes.u] / size_u, s.v_per_s = speed * over[axes.v] / size_v;
    }
    const double force_N = std::clamp<double>(static_cast<double>(c.normal_force_N), 0, kMostForce_N);
    s.level = static_cast<float>(settings_.gain * settings_.scrape_level * std::sqrt(mu * force_N * speed));
    s.place = place_of(listener_, place_world, settings_.nearest_m);
    out_.push_back(s);
  }
  std::erase_if(ways_, [](const auto& way) { return !way.second.seen; });
  return out_;
}

}  // namespace tactus::audio
