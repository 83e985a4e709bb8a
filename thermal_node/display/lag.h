// A display that answers slowly on purpose: first-order lag. Pure.
#pragma once

namespace tactus::thermal {

// y' = (x - y) / response, solved exactly for an x that holds over the step. Without a response y is x; when one
// begins y goes on from there, so that it is switched on without a jump. Realtime-safe: yes.
class Lag {
 public:
  explicit Lag(double start) : y_(start) {}

  // response_s: time constant; 0: none. An x that is no finite number leaves y.
  double step(double x, double dt_s, double response_s);
  // Goes on from here.
  void set(double y) { y_ = y; }

 private:
  double y_;
};

}  // namespace tactus::thermal
