// What holds, stops or drives a joint along one of its degrees of freedom, as rows that the solver sweeps with the
// contacts: limits, Coulomb friction, motors, and springs and dampers too stiff to be integrated.
#pragma once

#include <vector>

#include "sim_node/behaviour/articulated/articulated_system.h"
#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

struct JointRow {
  std::size_t rate = 0;                                 // the one that it acts along
  std::size_t first_rate = 0, rates = 0, response = 0;  // of the system: change of all its rates by a unit impulse
  double mobility = 0;
  double wanted = 0;           // rate, rad/s or m/s
  double softness = 0;         // a soft row asks for rate + softness * impulse = wanted
  double least = 0, most = 0;  // impulse, N m s or N s
  double impulse = 0;
  int ball = 0;              // of dry friction in a ball joint: 3, the first of three rows of one torque; 1: another of them
  int mover = 0;             // its system, numbered as for contacts
  double* memory = nullptr;  // where it is kept for the next step
};

// Impulses of each dof from step to step, to start from.
struct JointMemory {
  std::vector<double> friction, motor, limit, spring;
  explicit JointMemory(std::size_t dofs) : friction(dofs), motor(dofs), limit(dofs), spring(dofs) {}
};

// Whether a system has any such thing.
bool needs_rows(const articulated::ArticulatedSystem& system);

// Appends the rows of a system whose rates begin at first_rate. repair: share of an overrun limit that is taken
// back in a step. Responses go to the pool.
void append_rows(articulated::ArticulatedSystem& system, std::size_t first_rate, double h_s, double repair,
                 JointMemory& memory, std::vector<JointRow>& rows, std::vector<double>& pool);

// The same for the dry friction of ball joints, three rows for each.
void append_ball_friction(articulated::ArticulatedSystem& system, std::size_t first_rate, double h_s,
                          JointMemory& memory, std::vector<JointRow>& rows, std::vector<double>& pool);

// Adds to the impulse of a row, within its bounds; returns by how much the rate was off, rad/s or m/s.
double sweep(JointRow& row, const std::vector<double>& pool, Velocities& v);
void apply(const JointRow& row, double impulse, const std::vector<double>& pool, Velocities& v);

}  // namespace tactus::sim::impulse
