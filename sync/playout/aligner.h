// Estimates the delay that a modality needs, from an event to its earliest possible presentation, so that (nearly) all events
// arrive in time. The estimate uses the delays that earlier events needed. Pure.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "sync/time/time.h"

namespace tactus::sync {

enum class AlignerKind : std::uint8_t { kFixed, kQuantile };

class Aligner {
 public:
  virtual ~Aligner() = default;
  // Adds the delay that an event needed.
  virtual void add(Nanoseconds needed) = 0;
  // The delay for the next event; 0 before the first one.
  virtual Nanoseconds delay() const = 0;
};

// fixed: the delay of kFixed.
std::unique_ptr<Aligner> make_aligner(AlignerKind kind, Nanoseconds fixed);

// "fixed" or "quantile". Throws std::invalid_argument with one sentence for any other word.
AlignerKind parse_aligner(const std::string& word);
const char* name_of(AlignerKind kind);

}  // namespace tactus::sync
