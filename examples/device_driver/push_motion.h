// Integrates the push and twist of a 3D mouse to the pose of a tool: pushing sets the velocity, twisting the angular velocity. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tactus::examples {

class PushMotion {
 public:
  // design: spacenavd reports about 350 at full push by default: 0.3 m/s, an unhurried hand, and a quarter turn per second.
  static constexpr double kSpeed_m_s = 0.3 / 350, kSpin_rad_s = 1.57 / 350;
  // The daemon reports motion about 60 times per second and once when it ends. An older report has expired (design: three periods).
  static constexpr double kTimeout_s = 0.05;

  // half_m: range to each side of the origin along each axis, m.
  explicit PushMotion(double half_m) : half_m_(half_m) {}

  // Arguments in the axes of libspnav: x to the right, y up, z towards the person; twists about them. Stored in our axes: x away, y to the
  // left, z up.
  void push(int x, int y, int z, int rx, int ry, int rz) {
    push_ = {-double(z), -double(x), double(y)};
    twist_ = {-double(rz), -double(rx), double(ry)};
    remaining_s_ = kTimeout_s;
  }
  void press(int button, bool down) {
    if (button < 0 || button > 30) return;
    buttons_ = down ? buttons_ | 1 << button : buttons_ & ~(1 << button);
  }
  // dt > 0, s.
  void step(double dt) {
    const double on = remaining_s_ > 0 ? 1 : 0;
    remaining_s_ -= dt;
    double angle = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double to = std::clamp(position_[i] + on * push_[i] * kSpeed_m_s * dt, -half_m_, half_m_);
      velocity_[i] = (to - position_[i]) / dt;
      position_[i] = to;
      spin_[i] = on * twist_[i] * kSpin_rad_s;
      angle += spin_[i] * spin_[i];
    }
    turn(std::sqrt(angle) * dt, dt);
  }

  const std::array<double, 3>& position_m() const { return position_; }
  const std::array<double, 3>& velocity_m_s() const { return velocity_; }
  const std::array<double, 3>& spin_rad_s() const { return spin_; }
  const std::array<double, 4>& orientation() const { return orientation_; }  // unit quaternion, scalar first
  std::int32_t buttons() const { return buttons_; }

 private:
  // Rotates by the spin, about the axes of the world.
  void turn(double angle, double dt) {
    if (angle == 0) return;
    const double s = std::sin(angle / 2) * dt / angle, w = std::cos(angle / 2);
    const double x = spin_[0] * s, y = spin_[1] * s, z = spin_[2] * s;
    const auto [a, b, c, d] = orientation_;
    std::array<double, 4> q{w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                            w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a};
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& part : q) part /= norm;
    orientation_ = q;
  }

  double half_m_;
  std::array<double, 3> push_{}, twist_{}, position_{}, velocity_{}, spin_{};
  std::array<double, 4> orientation_{1, 0, 0, 0};
  double remaining_s_ = 0;
  std::int32_t buttons_ = 0;
};

}  // namespace tactus::examples
