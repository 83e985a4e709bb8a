// An independent oracle for the temperature of touched skin: nodes on the surfaces and on every border of layers
// (the models have cells and no such nodes), linear finite elements with lumped heat, Crank and Nicolson's rule
// started with backward Euler (Rannacher 1984), steps that grow with time, its own direct solver.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::thermal::oracle {

// Layer of skin or object: properties between two depths.
struct Slab {
  double thickness_m, conductivity_W_mK, heat_capacity_J_m3K;
  double blood_W_m3K = 0;
};

struct Touch {
  std::vector<Slab> skin;  // surface first, insulated at the back
  Slab object;             // insulated at the back, or open to the room
  double conductance_W_m2K;
  double skin_air_W_m2K = 0;    // of the touched surface to the room
  double object_air_W_m2K = 0;  // of the back of the object
  double skin_degC = 33, object_degC = 23, room_degC = 23, blood_degC = 33;
};

class FiniteDifferences {
 public:
  // finest_m: the first interval at the surface; each is `growth` times the previous one.
  explicit FiniteDifferences(const Touch& t, double finest_m = 1e-6, double growth = 1.01) : touch_(t) {
    for (const Slab& s : t.skin) append(s, finest_m, growth, points_.empty() ? 0 : last_interval_ * growth);
    surface_ = points_.size();
    last_interval_ = 0;
    append(t.object,
           finest_m * std::max(1.0, std::sqrt(t.object.conductivity_W_mK / t.object.heat_capacity_J_m3K / 1e-7)),
           growth, 0);
    const std::size_t n = points_.size();
    diagonal_.assign(n, 0), coupling_.assign(n, 0), source_.assign(n, 0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (i + 1 == surface_) continue;
      const double g = points_[i].to_next_W_m2K;
      couple(i, i + 1, g);
    }
    for (std::size_t i = 0; i < surface_; ++i) lose(i, points_[i].blood_W_m2K, t.blood_degC);
    // The skin is stored surface first, so the two surfaces, 0 and surface_, are not neighbours: see solve().
    lose(0, t.skin_air_W_m2K, t.room_degC);
    lose(n - 1, t.object_air_W_m2K, t.room_degC);
    diagonal_[0] += t.conductance_W_m2K, diagonal_[surface_] += t.conductance_W_m2K;
    u_.assign(n, t.skin_degC);
    std::fill(u_.begin() + static_cast<std::ptrdiff_t>(surface_), u_.end(), t.object_degC);
  }

  // Steady state of untouched skin. Call before advance().
  void begin_at_rest() {
    FiniteDifferences rest(*this);
    rest.diagonal_[0] -= touch_.conductance_W_m2K;
    rest.diagonal_[surface_] -= touch_.conductance_W_m2K;
    rest.touch_.conductance_W_m2K = 0;
    for (double dt = 1e-3; rest.time_s_ < 1e6; dt *= 1.05) rest.implicit(dt);
    begin_like(rest);
  }
  // With the skin of another oracle of the same layers.
  void begin_like(const FiniteDifferences& other) { std::copy_n(other.u_.begin(), surface_, u_.begin()); }

  // Advances to this time after the touch.
  void advance(double until_s) {
    for (; count_ < 4 && time_s_ < until_s; ++count_) implicit(1e-6);
    while (time_s_ < until_s * (1 - 1e-12))
      crank_nicolson(std::min(until_s - time_s_, std::max(1e-6, 2e-3 * time_s_)));
  }
  double surface_degC() const { return u_[0]; }

 private:
  struct Point {
    double heat_J_m2K = 0, to_next_W_m2K = 0, blood_W_m2K = 0;
  };

  void append(const Slab& s, double finest_m, double growth, double first) {
    std::vector<double> h;
    double sum = 0;
    for (double w = std::min(first > 0 ? first : finest_m, s.thickness_m / 4); sum < s.thickness_m; w *= growth)
      h.push_back(w), sum += w;
    for (double& w : h) w *= s.thickness_m / sum;
    if (points_.empty() || points_.size() == surface_) points_.emplace_back();
    for (const double w : h) {
      Point& here = points_.back();
      here.to_next_W_m2K = s.conductivity_W_mK / w;
      here.heat_J_m2K += s.heat_capacity_J_m3K * w / 2, here.blood_W_m2K += s.blood_W_m3K * w / 2;
      points_.push_back({s.heat_capacity_J_m3K * w / 2, 0, s.blood_W_m3K * w / 2});
    }
    last_interval_ = h.back();
  }
  void couple(std::size_t i, std::size_t j, double g) {
    diagonal_[i] += g, diagonal_[j] += g;
    coupling_[i] = g;
  }
  void lose(std::size_t i, double g, double degC) {
    diagonal_[i] += g;
    source_[i] += g * degC;
  }

  double out_of(std::size_t i) const {
    double q = diagonal_[i] * u_[i] - source_[i];
    if (i > 0 && i != surface_) q -= coupling_[i - 1] * u_[i - 1];
    if (i + 1 < u_.size() && i + 1 != surface_) q -= coupling_[i] * u_[i + 1];
    if (i == 0) q -= touch_.conductance_W_m2K * u_[surface_];
    if (i == surface_) q -= touch_.conductance_W_m2K * u_[0];
    return q;
  }
  void implicit(double dt) {
    std::vector<double> right(u_.size());
    for (std::size_t i = 0; i < u_.size(); ++i) right[i] = points_[i].heat_J_m2K * u_[i] + dt * source_[i];
    solve(dt, right);
    time_s_ += dt;
  }
  void crank_nicolson(double dt) {
    std::vector<double> right(u_.size());
    for (std::size_t i = 0; i < u_.size(); ++i)
      right[i] = points_[i].heat_J_m2K * u_[i] - dt / 2 * out_of(i) + dt / 2 * source_[i];
    solve(dt / 2, right);
    time_s_ += dt;
  }
  // (heat + w * conduction) u = right: each side is eliminated from its far end up to its surface; two equations
  // remain for the two surfaces.
  void solve(double w, std::vector<double>& right) {
    std::vector<double> d(u_.size());
    for (std::size_t i = 0; i < d.size(); ++i) d[i] = points_[i].heat_J_m2K + w * diagonal_[i];
    const auto up = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = to - 1; i > from; --i) {
        const double f = w * coupling_[i - 1] / d[i];
        d[i - 1] -= f * w * coupling_[i - 1];
        right[i - 1] += f * right[i];
      }
    };
    up(0, surface_), up(surface_, d.size());
    const double h = w * touch_.conductance_W_m2K, determinant = d[0] * d[surface_] - h * h;
    u_[0] = (right[0] * d[surface_] + h * right[surface_]) / determinant;
    u_[surface_] = (right[surface_] * d[0] + h * right[0]) / determinant;
    const auto down = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from + 1; i < to; ++i) u_[i] = (right[i] + w * coupling_[i - 1] * u_[i - 1]) / d[i];
    };
    down(0, surface_), down(surface_, d.size());
  }

  Touch touch_;
  std::vector<Point> points_;
  std::size_t surface_ = static_cast<std::size_t>(-1);  // of the object
  double last_interval_ = 0;
  std::vector<double> diagonal_, coupling_, source_, u_;
  double time_s_ = 0;
  int count_ = 0;
};

}  // namespace tactus::thermal::oracle
