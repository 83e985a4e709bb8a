// A free rigid body: its state, and its flight over one step without contacts.
#pragma once

#include <Eigen/Geometry>

#include "sim_node/model/body_motion.h"

namespace tactus::sim::impulse {

struct FreeBody {
  double mass_kg = 1;
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // about the centre of mass, body axes
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  double linear_damping_1_s = 0, angular_damping_1_s = 0;

  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  // At the middle of the previous step, so that steps of x += h v follow the parabola (leapfrog).
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double step_s = -1;  // length of that step; negative: equal to the next one
  Eigen::Vector3d spin_rad_s = Eigen::Vector3d::Zero();  // current

  // Act during the next step, at the centre of mass.
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero(), moment_N_m = Eigen::Vector3d::Zero();
};

// Motion of a body in the next step without contacts. World axes.
struct FreeMotion {
  Eigen::Matrix3d inertia, inverse_inertia;  // kg m^2, 1/(kg m^2)
  Eigen::Vector3d spin_momentum;             // kg m^2/s, at the end of the step
  Eigen::Vector3d start_m_s, mean_m_s;       // velocity at the start of the step, and its mean over it
  Eigen::Vector3d start_rad_s, mean_rad_s;   // angular velocity; rotation with the mean through the step gives the free orientation
};

// The last impact of a body within a step, after which it rotates with other angular momentum.
struct Blow {
  double time_s = -1;  // after the start of the step; negative: none
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  // rotation up to then
};

// Integrates the rotation of a torque-free body with exact angular momentum, by the classical Runge-Kutta method
// (Hairer, Norsett and Wanner 1993, table II.1.2). Real-time safe: yes.
FreeMotion free_motion(const FreeBody& body, double h_s);

// Completes a step in which the body moved with these mean velocities and got these offsets (m, rad). Angular momentum
// is exact, and rotation follows it, so that the kinetic energy of a body with unequal inertias does not drift. blow:
// its rotation up to the last impact; offset_rad then is that beyond the impacts.
void complete_step(FreeBody& body, const FreeMotion& motion, const Eigen::Vector3d& mean_m_s,
                   const Eigen::Vector3d& mean_rad_s, const Eigen::Vector3d& offset_m,
                   const Eigen::Vector3d& offset_rad, const Blow& blow, double h_s);

// Moves a body by an offset (m, rad); its velocities do not change.
void displace(FreeBody& body, const Eigen::Vector3d& by_m, const Eigen::Vector3d& by_rad);

// The velocity at the middle of a step of another length; 0: current.
Eigen::Vector3d velocity_for(const FreeBody& body, double step_s);

BodyMotion motion_of(const FreeBody& body);

}  // namespace tactus::sim::impulse
