// Tests of the setting `engine`.
#include <catch2/catch.hpp>

#include "sim_node/world/engine.h"

using namespace tactus::sim;

TEST_CASE("engine = parts leaves solver, detector and groups as they are") {
  Settings s;
  s.solver = "penalty", s.detector = "layers", s.groups = "dual";
  CHECK(apply_engine(s) == "");
  CHECK(s.solver == "penalty");
  CHECK(s.detector == "layers");
  CHECK(s.groups == "dual");
}

TEST_CASE("engine = ode selects ODE's solver and detector in one group") {
  Settings s;
  s.engine = "ode", s.groups = "dual";
  CHECK(apply_engine(s) == "");
  CHECK(s.solver == "quick");
  CHECK(s.detector == "ode");
  CHECK(s.groups == "single");

  Settings exact;
  exact.engine = "ode", exact.solver = "step";
  CHECK(apply_engine(exact) == "");
  CHECK(exact.solver == "step");
}

TEST_CASE("engine = tactus keeps solvers and detectors of this project") {
  Settings s;
  s.engine = "tactus", s.groups = "dual", s.solver = "penalty_explicit";
  CHECK(apply_engine(s) == "");
  CHECK(s.solver == "penalty_explicit");
  CHECK(s.groups == "dual");
}

TEST_CASE("A setting that contradicts the engine is named") {
  const auto error_of = [](const char* engine, const char* solver, const char* detector) {
    Settings s;
    s.engine = engine, s.solver = solver, s.detector = detector;
    return apply_engine(s);
  };
  CHECK(error_of("ode", "penalty", "auto") == "sim_node: engine = ode does not include solver = penalty; leave out one of the two");
  CHECK(error_of("ode", "quick", "gaps") == "sim_node: engine = ode does not include detector = gaps; leave out one of the two");
  CHECK(error_of("tactus", "step", "auto") == "sim_node: engine = tactus does not include solver = step; leave out one of the two");
  CHECK(error_of("ode", "custom:mine", "auto") == "sim_node: engine = ode does not include solver = custom:mine; leave out one of the two");
  CHECK(error_of("tactus", "impulse", "ode") == "sim_node: engine = tactus does not include detector = ode; leave out one of the two");
}
