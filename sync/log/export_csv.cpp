#include "sync/log/export_csv.h"

#include <cstdio>
#include <tactus/header_t.hpp>

#include "sync/resampling/sample_status.h"

namespace tactus::sync {
namespace {

// Whole nanoseconds as exact seconds: a double of CLOCK_MONOTONIC loses nanoseconds after three months.
std::string seconds(std::int64_t ns) {
  if (ns < 0) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(ns / 1'000'000'000),
                static_cast<long long>(ns % 1'000'000'000));
  return text;
}

std::string cell(const std::string& text) { return text; }
std::string cell(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.9g", value);
  return digits;
}
template <class Vector>
requires requires(const Vector& v) { v.z; }
std::string cell(const Vector& v) { return cell(v.x) + "," + cell(v.y) + "," + cell(v.z); }

template <class... Values>
std::string row(const header_t& h, const Values&... values) {
  std::string line = seconds(h.sim_time_ns) + "," + seconds(h.publish_time_ns);
  ((line += "," + cell(values)), ...);
  return line + "\n";
}

}  // namespace

std::string haptic_csv_names() {
  return "time_s,host_s,tool,device_x_m,device_y_m,device_z_m,proxy_x_m,proxy_y_m,proxy_z_m,force_x_N,force_y_N,"
         "force_z_N,torque_x_N_m,torque_y_N_m,torque_z_N_m,transient_x_N,transient_y_N,transient_z_N,fade,"
         "coupling,"
         "touch_status,constraints,energy_J,generated_J,injected_J,seq,run\n";
}

std::string csv_row(const tool_state_t& m, int run) {
  return row(m.header, m.tool, m.device.position_m, m.proxy.position_m, m.force_N, m.torque_N_m, m.transient_N, m.fade,
             m.coupling, to_string(static_cast<SampleStatus>(m.touch_status)), m.constraint_count, m.energy_J,
             m.generated_J, m.injected_J, std::to_string(m.header.seq), std::to_string(run));
}

std::string thermal_csv_names() {
  return "time_s,host_s,tool,material,force_N,area_m2,heat_flux_W_m2,skin_degC,commanded_degC,limited,run\n";
}

std::string csv_row(const thermal_state_t& m, int run) {
  return row(m.header, m.tool, m.material, m.force_N, m.area_m2, m.heat_flux_W_m2, m.skin_degC, m.commanded_degC, m.limited,
             std::to_string(run));
}

}  // namespace tactus::sync
