// First-order lag: a display that responds slowly on purpose. Pure.
#pragma once

namespace tactus::thermal {

// y' = (x - y) / response, solved exactly for a constant x over the step. With response 0, y is x. When the
// response changes, y continues from its value, without a jump. Realtime-safe: yes.
class Lag {
 public:
  explicit Lag(double start) : y_(start) {}

  // response_s: time constant; 0: none. An x that is not finite leaves y unchanged.
  double step(double x, double dt_s, double response_s);
  // Sets the current value.
  void set(double y) { y_ = y; }

 private:
  double y_;
};

}  // namespace tactus::thermal
