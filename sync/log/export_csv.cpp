#include "sync/log/export_csv.h"

#include <cstdio>
#include <tactus/header_t.hpp>

#include "sync/resampling/sample_status.h"
#include "sync/time/time.h"

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

class Row {
 public:
  Row& text(const std::string& value) {
    line_ += (line_.empty() ? "" : ",") + value;
    return *this;
  }
  Row& number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", value);
    return text(digits);
  }
  template <class Vector>
  Row& vector(const Vector& v) {
    return number(v.x).number(v.y).number(v.z);
  }
  Row& time(const header_t& h) {
    line_ = seconds(h.sim_time_ns) + "," + seconds(h.publish_time_ns);
    return *this;
  }
  std::string end() { return line_ + "\n"; }

 private:
  std::string line_;
};

}  // namespace

std::string haptic_csv_names() {
  return "time_s,host_s,tool,device_x_m,device_y_m,device_z_m,proxy_x_m,proxy_y_m,proxy_z_m,force_x_N,force_y_N,"
         "force_z_N,torque_x_N_m,torque_y_N_m,torque_z_N_m,transient_x_N,transient_y_N,transient_z_N,fade,"
         "coupling,"
         "touch_status,constraints,energy_J,generated_J,seq\n";
}

std::string csv_row(const tool_state_t& m) {
  return Row()
      .time(m.header)
      .number(m.tool)
      .vector(m.device.position_m)
      .vector(m.proxy.position_m)
      .vector(m.force_N)
      .vector(m.torque_N_m)
      .vector(m.transient_N)
      .number(m.fade)
      .number(m.coupling)
      .text(to_string(static_cast<SampleStatus>(m.touch_status)))
      .number(m.constraint_count)
      .number(m.energy_J)
      .number(m.generated_J)
      .text(std::to_string(m.header.seq))
      .end();
}

std::string thermal_csv_names() {
  return "time_s,host_s,tool,material,force_N,area_m2,heat_flux_W_m2,skin_degC,commanded_degC,limited\n";
}

std::string csv_row(const thermal_state_t& m) {
  return Row()
      .time(m.header)
      .number(m.tool)
      .number(m.material)
      .number(m.force_N)
      .number(m.area_m2)
      .number(m.heat_flux_W_m2)
      .number(m.skin_degC)
      .number(m.commanded_degC)
      .number(m.limited)
      .end();
}

}  // namespace tactus::sync
