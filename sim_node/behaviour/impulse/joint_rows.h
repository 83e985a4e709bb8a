// Joint constraints along one degree of freedom, as rows of the contact sweeps: limits, Coulomb friction, motors, and
// springs and dampers too stiff for explicit integration.
#pragma once

#include <vector>

#include "sim_node/behaviour/articulated/articulated_system.h"
#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

struct JointRow {
  std::size_t rate = 0;                                 // index of the rate that it acts along
  std::size_t first_rate = 0, rates = 0, response = 0;  // of the system: change of all its rates per unit impulse
  double mobility = 0;
  double target_rate = 0;      // target rate, rad/s or m/s
  double softness = 0;         // a soft row requires rate + softness * impulse = target_rate
  double min_impulse = 0, max_impulse = 0;  // limits of the impulse, N m s or N s
  double impulse = 0;
  int ball = 0;              // for dry friction of a ball joint: 3 in the first of three rows of one torque, 1 in the others
  int mover = 0;             // of its system, numbered as for contacts
  double* memory = nullptr;  // storage of the impulse for the next step
};

// Impulses of each dof from the last step, for the warm start.
struct JointImpulses {
  std::vector<double> friction, motor, limit, spring;
  explicit JointImpulses(std::size_t dofs) : friction(dofs), motor(dofs), limit(dofs), spring(dofs) {}
};

// Whether a system has such constraints.
bool needs_rows(const articulated::ArticulatedSystem& system);

// Appends the rows of a system whose rates begin at first_rate. Responses go to the pool.
void append_rows(articulated::ArticulatedSystem& system, std::size_t first_rate, double h_s, JointImpulses& memory,
                 std::vector<JointRow>& rows, std::vector<double>& pool);

// Writes the displacement of each degree of freedom that is outside its limits, m or rad: `share` of the violation in a step,
// at most at `speed`, m/s or rad/s, or back within a second from far away. Returns whether any is.
bool limit_corrections(const articulated::ArticulatedSystem& system, double h_s, double share, double speed, std::vector<double>& by);

// The same for dry friction of ball joints, three rows each.
void append_ball_friction(articulated::ArticulatedSystem& system, std::size_t first_rate, double h_s,
                          JointImpulses& memory, std::vector<JointRow>& rows, std::vector<double>& pool);

// Updates the impulse of a row within its bounds. Returns the error of the rate before the update, rad/s or m/s.
double sweep(JointRow& row, const std::vector<double>& pool, Velocities& v);
void apply(const JointRow& row, double impulse, const std::vector<double>& pool, Velocities& v);

}  // namespace tactus::sim::impulse
