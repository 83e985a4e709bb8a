// Tests of the tables haptic.csv and thermal.csv exported from a log.
#include "sync/log/export_csv.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/resampling/sample_status.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line.substr(0, line.find('\n')));
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

std::string cell(const std::string& names, const std::string& row, const std::string& name) {
  const auto columns = cells(names);
  return cells(row).at(
      static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin()));
}

}  // namespace

TEST_CASE("A row of haptic.csv has a value in every column") {
  tool_state_t m{};
  m.header.sim_time_ns = 1'234'567'891;
  m.header.publish_time_ns = 99'999'999'000'000'001;
  m.tool = 1;
  m.device.position_m.x = 0.1;
  m.proxy.position_m.z = -0.25;
  m.force_N.y = 2.5f;
  m.torque_N_m.x = -0.0625f;
  m.torque_N_m.y = 0.03125f;
  m.torque_N_m.z = 0.015625f;
  m.transient_N.z = 0.125f;
  m.fade = 0.5f;
  m.coupling = 0.75f;
  m.energy_J = -0.25f;
  m.generated_J = 0.001953125f;
  m.injected_J = 0.00390625f;
  m.touch_status = static_cast<std::int8_t>(SampleStatus::kHeld);
  const std::string names = haptic_csv_names(), row = csv_row(m);
  CHECK(cells(names).size() == cells(row).size());
  CHECK(cell(names, row, "time_s") == "1.234567891");
  CHECK(cell(names, row, "host_s") == "99999999.000000001");
  CHECK(cell(names, row, "tool") == "1");
  CHECK(cell(names, row, "device_x_m") == "0.1");
  CHECK(cell(names, row, "proxy_z_m") == "-0.25");
  CHECK(cell(names, row, "force_y_N") == "2.5");
  CHECK(cell(names, row, "torque_x_N_m") == "-0.0625");
  CHECK(cell(names, row, "torque_y_N_m") == "0.03125");
  CHECK(cell(names, row, "torque_z_N_m") == "0.015625");
  CHECK(cell(names, row, "transient_z_N") == "0.125");
  CHECK(cell(names, row, "fade") == "0.5");
  CHECK(cell(names, row, "coupling") == "0.75");
  CHECK(cell(names, row, "energy_J") == "-0.25");
  CHECK(cell(names, row, "generated_J") == "0.001953125");
  CHECK(cell(names, row, "injected_J") == "0.00390625");
  CHECK(cell(names, row, "touch_status") == "held");
}

TEST_CASE("A row of thermal.csv has a value in every column") {
  thermal_state_t m{};
  m.header.sim_time_ns = -1;
  m.header.publish_time_ns = 5;
  m.skin_degC = 33.5f;
  m.limited = 1;
  m.heat_flux_W_m2 = -120;
  const std::string names = thermal_csv_names(), row = csv_row(m);
  CHECK(cells(names).size() == cells(row).size());
  CHECK(cell(names, row, "time_s").empty());
  CHECK(cell(names, row, "host_s") == "0.000000005");
  CHECK(cell(names, row, "skin_degC") == "33.5");
  CHECK(cell(names, row, "heat_flux_W_m2") == "-120");
  CHECK(cell(names, row, "limited") == "1");
}
