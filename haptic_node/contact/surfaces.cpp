#include "haptic_node/contact/surfaces.h"

#include <algorithm>
#include <cmath>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

Eigen::Vector3d clamped(const Eigen::Vector3d& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Eigen::Vector3d(v * (limit / norm)) : v;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a == b ? 0.0 : std::atan2(a.cross(b).norm(), a.dot(b));
}

// True when the angle between them is certainly no larger, by the chord: its square is 2 - 2 cos x >= x^2 - x^4 /
// 12. Nearly all surfaces turn less, and need no arctangent.
bool angle_within(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double angle_rad) {
  const double square = angle_rad * angle_rad;
  return (a - b).squaredNorm() <= square - square * square / 12;
}

// Rotates `from` towards `to` by at most max_angle_rad.
Eigen::Vector3d rotate_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double max_angle_rad) {
  if (angle_within(from, to, max_angle_rad) || angle_between(from, to) <= max_angle_rad) return to;
  Eigen::Vector3d axis = from.cross(to);
  if (axis.norm() < 1e-9) axis = from.unitOrthogonal();  // opposite: all directions are equally short
  return (Eigen::AngleAxisd(max_angle_rad, axis.normalized()) * from).normalized();
}

// The message validation rejects other planes; one that arrives by another way is left out.
bool valid_plane(const touch_plane_t& p) {
  const double square = to_eigen(p.normal).squaredNorm();
  return square > 0 && std::isfinite(square) && to_eigen(p.point_m).allFinite() &&
         to_eigen(p.velocity_m_s).allFinite() && to_eigen(p.angular_velocity_rad_s).allFinite() &&
         p.effective_mass_kg > 0 && std::isfinite(p.stiffness_N_m) && std::isfinite(p.damping_N_s_m) &&
         std::isfinite(p.friction_static) && std::isfinite(p.friction_dynamic);
}

// A plane under another id continues a still surface within these differences. Design: the facets of a fine mesh differ by
// more, and are surfaces of their own.
constexpr double kSameNormal_rad = 0.01, kSamePlace_m = 0.0001;

// Above any apparent rotation of a body for a hand: one radian in 10 ms.
constexpr double kMaxSpin_rad_s = 100;

}  // namespace

const Surface* Surfaces::find(std::int64_t contact_id, std::size_t expected) const {
  const std::size_t n = list_.size();
  for (std::size_t k = 0, i = expected < n ? expected : 0; k < n; ++k, i = i + 1 < n ? i + 1 : 0)
    if (list_[i].contact_id == contact_id) return &list_[i];
  return nullptr;
}

Surfaces::PredictedPlane Surfaces::predict(const Surface& s) const {
  if (!now_) return {s.published_point_, s.published_normal_, Eigen::Quaterniond::Identity()};
  const double age = std::clamp(sync::to_seconds(*now_ - s.at_), 0.0, limits_.max_extrapolation_s);
  const double spin = s.angular_velocity.norm();
  PredictedPlane predicted{s.published_point_ + age * s.velocity, s.published_normal_,
                           Eigen::Quaterniond::Identity()};
  if (spin == 0 || age == 0) return predicted;
  // Rodrigues' formula; the full rotation only for a surface with a map.
  const Eigen::Vector3d axis = s.angular_velocity / spin, across = axis.cross(predicted.normal);
  const double sine = std::sin(spin * age), cosine = std::cos(spin * age);
  predicted.normal = (predicted.normal + sine * across + (1 - cosine) * axis.cross(across)).normalized();
  if (s.mapped.material >= 0) predicted.rotation = Eigen::AngleAxisd(spin * age, axis);
  return predicted;
}

double Surfaces::true_height(const PredictedPlane& predicted, const Eigen::Vector3d& place) const {
  return predicted.normal.dot(place - predicted.point) - radius_m_;
}

void Surfaces::update(const touch_plane_t& plane, sync::SimTime at, const Eigen::Vector3d& proxy,
                      std::size_t expected) {
  Surface* const known = const_cast<Surface*>(find(plane.contact_id, expected));
  const bool added = known == nullptr;
  Surface& s = added ? list_.emplace_back() : *known;
  // Height of the proxy above the plane as rendered so far, predicted to now.
  const double rendered = added ? 0 : true_height(predict(s), tool_point_at(s.tool_point, proxy)) + s.lag_m_;
  s.contact_id = plane.contact_id;
  s.body = plane.body;
  s.effective_mass_kg = plane.effective_mass_kg;
  s.stiffness_N_m = plane.stiffness_N_m;
  s.damping_N_s_m = plane.damping_N_s_m;
  s.friction_static = plane.friction_static;
  s.friction_dynamic = std::min(plane.friction_dynamic, plane.friction_static);
  s.velocity = clamped(to_eigen(plane.velocity_m_s), limits_.surface_speed_limit_m_s);
  s.angular_velocity = clamped(to_eigen(plane.angular_velocity_rad_s), kMaxSpin_rad_s);
  s.tool_point = to_eigen(plane.tool_point_m);
  s.published_point_ = to_eigen(plane.point_m);
  s.published_normal_ = to_eigen(plane.normal).normalized();
  s.mapped.set_plane(plane, s.published_normal_);
  s.at_ = at;
  s.remaining_s_ = -1;
  s.in_model_ = true;
  const PredictedPlane predicted = predict(s);
  if (added) s.normal = predicted.normal;
  // Under pressure every jump is smoothed; otherwise only one that would push the proxy.
  const double height = true_height(predicted, tool_point_at(s.tool_point, proxy));
  // A lag in progress continues, also in front of the hand, between walls that leave it no room.
  const double pushes = std::max(0.0, -height);
  if (added) s.appeared_m = pushes, s.held = !s.movable() && pushes > deep_m_;
  s.lag_m_ = s.depth_m > 0 ? rendered - height : added ? pushes : std::clamp(rendered - height, 0.0, pushes);
  s.lag_speed_m_s_ = std::max(limits_.recovery_speed_m_s, std::abs(s.lag_m_) / limits_.recovery_time_s);
  if (s.depth_m <= 0) s.normal = predicted.normal;
  s.normal_rate_rad_s_ = limits_.recovery_turn_rad_s;
  if (!angle_within(s.normal, predicted.normal, limits_.recovery_turn_rad_s * limits_.recovery_time_s))
    s.normal_rate_rad_s_ =
        std::max(s.normal_rate_rad_s_, angle_between(s.normal, predicted.normal) / limits_.recovery_time_s);
}

// The simulation gives a contact another id when it has ended. A late model then renames a surface while the hand is
// already on it again: it continues instead of giving way to a new one.
void Surfaces::continue_renamed(const TouchModelView& model, const std::bitset<kMaxOffered>& chosen,
                                const Eigen::Vector3d& proxy) {
  const std::size_t offered = std::min(model.plane_count(), kMaxOffered);
  const auto in_model = [&](std::int64_t id) {
    for (std::size_t i = 0; i < offered; ++i)
      if (model.plane(i).contact_id == id) return true;
    return false;
  };
  for (std::size_t i = 0; i < offered; ++i) {
    const touch_plane_t& p = model.plane(i);
    if (!chosen[i] || !valid_plane(p) || find(p.contact_id, i)) continue;
    const Eigen::Vector3d normal = to_eigen(p.normal).normalized(), tool_point = to_eigen(p.tool_point_m);
    const double height_m = true_height({to_eigen(p.point_m), normal}, tool_point_at(tool_point, proxy));
    for (Surface& s : list_) {
      if (s.body != p.body || !s.still() || s.remaining_s_ >= 0 || (s.tool_point - tool_point).norm() > kSamePlace_m ||
          !angle_within(s.published_normal_, normal, kSameNormal_rad))
        continue;
      const double before_m = true_height(predict(s), tool_point_at(s.tool_point, proxy));
      if (std::abs(before_m - height_m) > kSamePlace_m || in_model(s.contact_id)) continue;
      s.contact_id = p.contact_id;
      break;
    }
  }
}

void Surfaces::start_removal(Surface& s) {
  if (s.remaining_s_ < 0) s.remaining_s_ = limits_.recovery_time_s;
}

std::bitset<Surfaces::kMaxOffered> Surfaces::select_planes(const TouchModelView& model,
                                                           const Eigen::Vector3d& proxy,
                                                           std::size_t max_planes) const {
  const std::size_t offered = std::min(model.plane_count(), kMaxOffered);
  std::bitset<kMaxOffered> chosen;
  if (offered <= std::min(max_planes, kMaxPresent)) {  // the usual case: no selection
    for (std::size_t i = 0; i < offered; ++i) chosen.set(i);
    return chosen;
  }
  // A pressed plane precedes all others, so that the selection does not alternate when too many press.
  struct Rank {
    bool free;
    // depth of the device under a pressed surface, as a negative height; otherwise height of the proxy over it
    double height_m;
    std::size_t index;
    auto operator<=>(const Rank&) const = default;
  };
  std::array<Rank, kMaxOffered> ranks;
  for (std::size_t i = 0; i < offered; ++i) {
    const touch_plane_t& p = model.plane(i);
    const Surface* known = find(p.contact_id, i);
    const bool pressed = known && known->depth_m > 0;
    ranks[i] = {!pressed,
                pressed ? -known->depth_m
                        : true_height({to_eigen(p.point_m), to_eigen(p.normal).normalized()},
                                      tool_point_at(to_eigen(p.tool_point_m), proxy)),
                i};
  }
  const std::size_t count = std::min({offered, max_planes, kMaxPresent});
  std::partial_sort(ranks.begin(), ranks.begin() + count, ranks.begin() + offered);
  for (std::size_t i = 0; i < count; ++i) chosen.set(ranks[i].index);
  return chosen;
}

void Surfaces::update(const TouchModelView& model, const Eigen::Vector3d& proxy, std::size_t max_planes) {
  const auto chosen = select_planes(model, proxy, max_planes);
  for (Surface& s : list_) s.in_model_ = false;
  continue_renamed(model, chosen, proxy);
  // The list usually has the order of the planes, so each search starts at its own index.
  for (std::size_t i = 0; i < kMaxOffered; ++i)
    if (chosen[i] && valid_plane(model.plane(i)))
      update(model.plane(i), sync::sim_time(model.header().sim_time_ns), proxy, i);
  for (Surface& s : list_)
    if (!s.in_model_) start_removal(s);
}

void Surfaces::remove_expired() {
  std::erase_if(list_,
                [](const Surface& s) { return s.remaining_s_ == 0 || (s.remaining_s_ > 0 && s.depth_m <= 0); });
  // Surfaces that leave have the last places; the one nearest its end goes first. The order is nearly always
  // already right. Insertion sort: std::stable_sort would allocate memory, and the list is nearly sorted.
  const auto rank = [](const Surface& s) { return s.remaining_s_ < 0 ? 1e9 : s.remaining_s_; };
  const auto before = [&](const Surface& x, const Surface& y) { return rank(x) > rank(y); };
  if (!std::is_sorted(list_.begin(), list_.end(), before))
    for (auto next = list_.begin(); next != list_.end(); ++next)
      std::rotate(std::upper_bound(list_.begin(), next, *next, before), next, next + 1);
  if (list_.size() > kMaxHalfSpaces) list_.erase(list_.begin() + kMaxHalfSpaces, list_.end());
}

// The lag of the surface goes to zero. height_m: of the tool over the true surface.
void Surfaces::rise(Surface& s, double height_m, double dt) const {
  double step_m = s.lag_speed_m_s_ * dt;
  if (s.lag_m_ <= 0) {
    s.lag_m_ = std::min(0.0, s.lag_m_ + step_m);
    s.held = false;
    return;
  }
  if (s.held) {
    // A hand that leaves takes the surface with it, without a force.
    if (s.depth_m <= 0) s.lag_m_ = std::min(s.lag_m_, std::max(0.0, -height_m));
    // K (d z + z^2 / 2) <= E for the rise z at depth d. K is not yet known in the first tick.
    const double K = s.coupling_stiffness_N_m, depth_m = std::max(0.0, s.depth_m);
    step_m = K > 0 ? std::min(step_m, std::sqrt(depth_m * depth_m + 2 * rise_J_ / K) - depth_m) : 0;
  }
  s.lag_m_ = std::max(0.0, s.lag_m_ - step_m);
}

void Surfaces::render(Surface& s, const Eigen::Vector3d& proxy, double dt) const {
  const PredictedPlane predicted = predict(s);
  if (s.remaining_s_ > 0) {
    // Retracts so that the depth is zero when the time is over.
    s.lag_m_ += s.depth_m * std::min(1.0, dt / s.remaining_s_);
    s.remaining_s_ = std::max(0.0, s.remaining_s_ - dt);
  } else {
    rise(s, true_height(predicted, tool_point_at(s.tool_point, proxy)), dt);
  }
  s.normal = rotate_towards(s.normal, predicted.normal, s.normal_rate_rad_s_ * dt);
  // While it turns it pivots about the place under the proxy, where the height is correct.
  s.offset_m = s.normal.dot(proxy) - (true_height(predicted, tool_point_at(s.tool_point, proxy)) + s.lag_m_);
  s.point = predicted.point;
  if (s.mapped.material >= 0) s.mapped.rotate(predicted.rotation.toRotationMatrix());
}

void Surfaces::step(const TouchModelView& fresh, std::optional<sync::SimTime> now, const Eigen::Vector3d& proxy,
                    double dt, std::size_t max_planes) {
  now_ = now;
  remove_expired();
  if (fresh) update(fresh, proxy, max_planes);
  remove_expired();
  for (Surface& s : list_) render(s, proxy, dt);
}

}  // namespace tactus::haptic
