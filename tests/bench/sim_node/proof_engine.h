// Interface of a physics engine for the proofs: a few bodies, a step, and their motion. Implemented by our engine and by ODE alone.
#pragma once

#include <Eigen/Geometry>
#include <memory>

namespace tactus::bench {

inline constexpr double kG = 9.81;

class Engine {
 public:
  virtual ~Engine() = default;
  virtual void set_gravity(const Eigen::Vector3d& m_s2) = 0;  // before any body
  virtual void plane(const Eigen::Vector3d& normal, double friction,
                     double restitution) = 0;  // through the origin; first
  // Each returns the number of the body.
  virtual int ball(double mass, double r, const Eigen::Vector3d& place, double friction, double restitution) = 0;
  virtual int box(double mass, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose, double friction,
                  double restitution) = 0;
  virtual int rod(double mass, double length, double r, const Eigen::Isometry3d& pose,
                  double friction) = 0;  // along x
  // Links of 0.1 m, 50 g and r = 1 cm along +x from the origin, on universal joints about y and z; the first joint rotates at this rate
  // about the vertical.
  virtual void chain(int links, double about_vertical_rad_s) = 0;
  // One such link along -z, hung on a ball joint at the origin; a ball may strike it.
  virtual int hanging_rod(double restitution) = 0;
  // A rod on a hinge along y at the origin, released at that angle from hanging.
  virtual void pendulum(double angle_rad) = 0;

  virtual void set_motion(int body, const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& spin_rad_s) = 0;
  virtual void step(double h_s) = 0;
  virtual Eigen::Vector3d position(int body) = 0;  // centre of mass
  virtual Eigen::Quaterniond orientation(int body) = 0;
  virtual Eigen::Vector3d velocity(int body) = 0;  // velocity and spin: of a free body
  virtual Eigen::Vector3d spin(int body) = 0;
  virtual double contact_force_N() = 0;  // sum along the normals, of the last step
  virtual double chain_energy_J() = 0;   // energy of chain or pendulum
  virtual double joint_gap_m() = 0;
  virtual double pendulum_angle_rad() = 0;
  virtual Eigen::Vector3d link_spin() = 0;  // angular velocity of the hanging rod, world frame
};

std::unique_ptr<Engine> make_ours();
// quick: dWorldQuickStep with its 20 iterations, otherwise dWorldStep. Contact joints are set up as in the manual.
std::unique_ptr<Engine> make_ode(bool quick);

}  // namespace tactus::bench
