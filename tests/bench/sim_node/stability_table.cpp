// Penalty against analytic contact: cost of a step, finite and continuous forces, the step that a stiffness needs, and the contact
// stiffness limit at a given step; then the same scene in one group and in two. Measures Table 1 of Kim, Sung, Park 2005 and its claim of
// better stability.
//
//    bin/stability_table [--json FILE]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "sync/node/node_options.h"
#include "tests/bench/sim_node/stability.h"
#include "tests/bench/sim_node/stability_groups.h"
#include "tests/sim_node/support/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::bench;
using namespace tactus::sim::test;
using nlohmann::json;

namespace {

// design: a shell thick enough to stop 1 m/s.
constexpr double kShell_m = 0.02;

// A method of solving contact.
struct Model {
  std::string name;
  // Advances a scene by h, in any number of internal steps.
  std::function<void(Toys&, double h)> step;
  std::function<impulse::ContactLaw(double stiffness, double damping)> law;
};

impulse::ContactLaw penalty(double k, double d, bool is_explicit) {
  impulse::ContactLaw law;
  if (k > 0) law.penalty = {k, d, kShell_m, is_explicit};
  return law;
}

std::vector<Model> models() {
  const auto step = [](Toys& toys, double h) { toys.step(h); };
  return {{"penalty, explicit", step, [](double k, double d) { return penalty(k, d, true); }},
          {"penalty, implicit", step, [](double k, double d) { return penalty(k, d, false); }},
          {"analytic", step, [](double, double) { return penalty(0, 0, false); }}};
}

// A tower of boxes, or a ball, at rest in its springs.
struct Resting {
  Toys toys;
  std::vector<std::pair<int, double>> bodies;  // and their mass

  // boxes: in the tower; 0: a ball. k 0: hard contact, under the gravity of the earth.
  Resting(const impulse::ContactLaw& law, int boxes, double k) : toys(law) {
    const double each = k > 0 ? bend_m(k) : 0, up = kBends * each;
    toys.reach_m = up + 0.002;
    toys.plane({0, 0, 1}, {0, 0, 0});
    if (boxes == 0) bodies.emplace_back(toys.ball(kLightest_kg, 0.03, {0, 0, 0.03 + up - each}), kLightest_kg);
    double z = 0;
    for (int i = 0; i < boxes; ++i) {
      z += up - (boxes - i) * each;
      bodies.emplace_back(
          toys.box(4 * kLightest_kg, {0.1, 0.1, 0.1}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, z + 0.05))),
          4 * kLightest_kg);
      z += 0.1;
    }
  }
  double kinetic_J() const {
    double sum = 0;
    for (const auto& [body, mass] : bodies) {
      const BodyMotion& m = toys.motion(body);
      const Eigen::Matrix3d inertia = m.inverse_inertia.inverse();
      sum += mass / 2 * m.velocity_m_s.squaredNorm() + m.spin_rad_s.dot(inertia * m.spin_rad_s) / 2;
    }
    return sum;
  }
};

// Whether the motion after a random push of 1 um/s decays or at least does not grow. It may grow at first, as an oscillation near its
// limit does, by 1/sqrt(1 - h^2 k / 4 m): ten times within 1 % of it, a hundred times in energy.
bool stays_stable(const Model& model, int boxes, double x, double h) {
  const double k = x * kLightest_kg / (h * h), d = kDampingRatio * 2 * std::sqrt(k * kLightest_kg);
  impulse::ContactLaw law = model.law(k, d);
  law.penalty.thickness_m = kBends * bend_m(k);
  Resting r(law, boxes, law.penalty.stiffness_N_m == 0 ? 0 : k);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1e-6, 1e-6);
  for (int i = 0; i < 20; ++i) model.step(r.toys, h);
  for (const auto& [body, mass] : r.bodies) {
    r.toys.world.free_body(body).velocity_m_s += Eigen::Vector3d(u(random), u(random), u(random));
    r.toys.world.free_body(body).spin_rad_s += Eigen::Vector3d(u(random), u(random), u(random)) / 0.05;
  }
  const double first = static_cast<double>(r.bodies.size()) * 4 * kLightest_kg * 1e-12;
  for (int i = 0; i < 3000; ++i) {
    model.step(r.toys, h);
    if (!(r.kinetic_J() < 100 * first)) return false;
  }
  return true;
}

// The largest stable k h^2 / m; 0: none, because a softer tower topples for lack of stiffness.
double stiffest(const Model& model, int boxes, double h) {
  return largest_stable(kStiffestTried, 0.01, [&](double x) { return stays_stable(model, boxes, x, h); });
}

// A ball that arrives at 1 m/s: its largest force, and the largest change from one step to the next.
struct Arrival {
  double max_N = 0, jump_N = 0;
};
Arrival arrive(const Model& model, double k, double h) {
  impulse::ContactLaw law = model.law(k, 1);
  Toys toys(law);
  toys.reach_m = kShell_m + 0.02;
  toys.gravity_m_s2.setZero();
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.5, 0);
  const int ball = toys.ball(kLightest_kg, 0.03, {0, 0, 0.03 + kShell_m + 0.0101});
  toys.world.free_body(ball).velocity_m_s = {0, 0, -1};
  Arrival out;
  double before = 0;
  for (double t = 0; t < 0.08; t += h) {
    model.step(toys, h);
    const double force = toys.force_N();
    out.max_N = std::max(out.max_N, force);
    out.jump_N = std::max(out.jump_N, std::abs(force - before));
    before = force;
  }
  return out;
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

// Median duration of a step of 100 boxes at rest, contacts found beforehand, us.
double cost_us(const Model& model, double k, double h) {
  Toys toys(model.law(k, 5));
  toys.reach_m = 0.002;
  toys.plane({0, 0, 1}, {0, 0, 0});
  const bool presses = k > 0 && model.name != "analytic";
  const double depth = presses ? 4 * kLightest_kg * kToyG / (4 * k) : 0, up = presses ? kShell_m - depth : 0;
  if (presses) toys.reach_m = kShell_m + 0.002;
  for (int i = 0; i < 100; ++i)
    toys.box(4 * kLightest_kg, {0.1, 0.1, 0.1},
             Eigen::Isometry3d(Eigen::Translation3d(0.2 * (i % 10), 0.2 * (i / 10), 0.05 + up)));
  std::vector<double> took;
  for (int i = 0; i < 300; ++i) {
    toys.collide(h);
    const auto begin = std::chrono::steady_clock::now();
    toys.solve(h);
    took.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  return median(took);
}

// "> most" when there is no limit.
std::string limit(double x, double max, const char* form) {
  char text[32];
  std::snprintf(text, sizeof text, x >= max ? "> %.0e" : x > 0 ? form : "none", x);
  return text;
}

// The whole simulation, in one group and in two.
json groups() {
  constexpr double kStiffestHand_N_m = 1e6, kSoftestHand_N_m = 50;
  json out = json::array();
  std::printf("\n%-26s | %-44s | %s\n%-26s | %10s %12s %8s %12s | %s\n", "a hand beside, the same far away",
              "largest stable k h^2/m, and k in N/m", "hands that hold a box", "contact", "ball", "N/m", "tower",
              "N/m", "of 200 g, N/m each");
  for (const GroupedRow& row : grouped_rows()) {
    json r = {{"contact", row.name}, {"step_s", row.step_s}};
    std::printf("%-26s |", row.name.c_str());
    for (const int boxes : {0, 3}) {
      const double x =
          largest_stable(kStiffestTried, 0.01, [&](double tried) { return grouped_stays_stable(row, boxes, tried); });
      const double to_N_m = kLightest_kg / (row.step_s * row.step_s);
      std::printf(boxes ? " %8s %12s" : " %10s %12s", limit(x, kStiffestTried, "%.2f").c_str(),
                  limit(x * to_N_m, kStiffestTried * to_N_m, "%.0f").c_str());
      std::fflush(stdout);
      const std::string what = boxes ? "tower" : "ball";
      r[what + "_kh2_m"] = x;
      r[what + "_N_m"] = x * to_N_m;
    }
    const double hand = largest_stable(kStiffestHand_N_m, kSoftestHand_N_m, [&](double k) { return two_hands_stay_stable(row, k); });
    std::printf(" | %s\n", limit(hand, kStiffestHand_N_m, "%.0f").c_str());
    std::fflush(stdout);
    r["hand_N_m"] = hand;
    out.push_back(r);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  tactus::sync::Arguments app("Penalty and analytic contact: cost, forces, stability");
  std::string file;
  app.add_option("--json", file, "Writes the figures here");
  tactus::sync::parse_or_exit(app, "stability_table", argc, argv);
  json out = json::array();
  const double k = 1e4;
  double at_1ms_N_m = 0, at_60Hz_N_m = 0;
  std::printf(
      "lightest body %.2g kg per point of contact; shell %g mm; stiffness %g N/m where it is not the result\n\n",
      kLightest_kg, 1e3 * kShell_m, k);
  std::printf("%-18s %11s | %-38s | %-25s | %s\n", "", "step of 100", "largest force of 1 m/s, N, at a step",
              "largest change in a step", "largest stable k h^2/m at 1 ms and 1/60 s");
  std::printf("%-18s %11s | %12s %12s %12s | %12s %12s | %8s %8s | %8s %8s\n", "contact", "boxes, us", "of 1 ms",
              "0.1 ms", "0.01 ms", "0.1 ms", "0.01 ms", "ball", "", "tower", "");
  for (const Model& model : models()) {
    const double us = cost_us(model, k, 0.001);
    const Arrival at_1 = arrive(model, k, 1e-3), at_01 = arrive(model, k, 1e-4), at_001 = arrive(model, k, 1e-5);
    std::printf("%-18s %11.1f | %12.2f %12.2f %12.2f | %12.3f %12.3f |", model.name.c_str(), us, at_1.max_N,
                at_01.max_N, at_001.max_N, at_01.jump_N, at_001.jump_N);
    json row = {{"contact", model.name},           {"step_100_boxes_us", us},
                {"force_1ms_N", at_1.max_N},      {"force_0.1ms_N", at_01.max_N},
                {"force_0.01ms_N", at_001.max_N}, {"change_0.1ms_N", at_01.jump_N},
                {"change_0.01ms_N", at_001.jump_N}};
    for (const int boxes : {0, 3}) {
      for (const double h : {0.001, 1.0 / 60}) {
        const double max = stiffest(model, boxes, h);
        std::printf(" %8s", limit(max, kStiffestTried, "%.2f").c_str());
        if (model.name == "penalty, explicit" && boxes)
          (h < 0.01 ? at_1ms_N_m : at_60Hz_N_m) = max * kLightest_kg / (h * h);
        row[std::string(boxes ? "tower" : "ball") + (h < 0.01 ? "_kh2_m_1ms" : "_kh2_m_60Hz")] = max;
      }
      std::printf(boxes ? "\n" : " |");
    }
    out.push_back(row);
  }
  // The step that a spring of this stiffness needs, by the bound and as measured.
  std::printf(
      "\nforce of the spring itself: v sqrt(k m) = %.2f N; explicit bound: k h^2 + 2 h d < 4 m, here k h^2/m < "
      "%.2f\n",
      std::sqrt(k * kLightest_kg),
      std::pow(std::sqrt(4 + 4 * kDampingRatio * kDampingRatio) - 2 * kDampingRatio, 2));
  std::printf(
      "the tower's explicit springs: %.0f N/m at 1 ms, %.0f N/m at 1/60 s: the gain of 1 kHz for the felt stiffness "
      "is a factor of "
      "%.0f\n",
      at_1ms_N_m, at_60Hz_N_m, at_1ms_N_m / at_60Hz_N_m);
  const json grouped = groups();
  if (!file.empty()) std::ofstream(file) << json{{"contact", out}, {"groups", grouped}}.dump(1) << "\n";
}
