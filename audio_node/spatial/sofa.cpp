#include "audio_node/spatial/sofa.h"

#include <mysofa.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "sync/sandbox/regular_file.h"

namespace tactus::audio {
namespace {

constexpr double kSameDistance_m = 0.01;
constexpr unsigned kMinDirections = 4;  // minimum to surround a head
// Twice the largest published set (TH Koeln, Neumann KU 100: 16,020 directions); hulls take quadratic time.
constexpr unsigned kMaxDirections = 32'768;
// 1.4 s at 48 kHz; a response of the free field has a few hundred samples.
constexpr unsigned kMaxSamples = 65'536;
constexpr std::size_t kMaxResponseValues = 50'000'000;  // 200 MB (design)
constexpr double kMinRate_Hz = 8'000, kMaxRate_Hz = 384'000;
constexpr double kMaxDistance_m = 1e3;
// 60 dB above a response of full scale; a larger value is another unit or damage, and its energy could overflow.
constexpr float kMaxResponse = 1e3f;
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{512} << 20;

struct Free {
  void operator()(MYSOFA_HRTF* file) const { mysofa_free(file); }
};

// why: a fault of the file, as the end of a sentence about it.
[[noreturn]] void reject(const std::string& why) { throw std::runtime_error(why); }

bool has(const MYSOFA_ARRAY& array, std::size_t count) { return array.values && array.elements >= count; }

// ReceiverPosition has 3 x R values, or that for each measurement (AES69: "R,C,I" or "R,C,M").
bool per_measurement(const MYSOFA_ARRAY& array) {
  for (const MYSOFA_ATTRIBUTE* a = array.attributes; a; a = a->next)
    if (a->name && a->value && std::strcmp(a->name, "DIMENSION_LIST") == 0) return std::strcmp(a->value, "R,C,M") == 0;
  return false;
}

Eigen::Vector3d position(const MYSOFA_HRTF& file, std::size_t i) {
  const float* p = file.SourcePosition.values + 3 * i;
  return Eigen::Vector3f(p[0], p[1], p[2]).cast<double>();
}

// Reads all directions at the largest distance.
MeasuredHrtf measured_of(const MYSOFA_HRTF& file) {
  // AES69: the receivers of SimpleFreeFieldHRIR are left and right; the receiver positions show if a file swaps
  // them.
  const bool turned = file.ReceiverPosition.values[1] < 0;
  double far_m = 0;
  for (std::size_t i = 0; i < file.M; ++i) {
    const double distance_m = position(file, i).norm();
    if (!(distance_m <= kMaxDistance_m)) reject("has a direction that is not finite");
    far_m = std::max(far_m, distance_m);
  }
  MeasuredHrtf measured;
  measured.rate_Hz = static_cast<double>(file.DataSamplingRate.values[0]);
  measured.samples = static_cast<int>(file.N);
  for (std::size_t i = 0; i < file.M; ++i) {
    const Eigen::Vector3d at = position(file, i);
    if (!(at.norm() > far_m - kSameDistance_m)) continue;
    measured.directions.push_back(at.normalized());
    for (std::size_t ear = 0; ear < 2; ++ear) {
      const std::size_t receiver = turned ? 1 - ear : ear;
      const float* from = file.DataIR.values + (2 * i + receiver) * file.N;
      measured.responses.insert(measured.responses.end(), from, from + file.N);
      const bool each = file.DataDelay.elements == 2 * file.M;
      measured.delays.push_back(static_cast<double>(file.DataDelay.values[(each ? 2 * i : 0) + receiver]));
    }
  }
  if (!std::all_of(measured.responses.begin(), measured.responses.end(),
                   [](float x) { return std::abs(x) <= kMaxResponse; }))
    reject("has values that are not finite, or far beyond any response");
  if (!std::all_of(measured.delays.begin(), measured.delays.end(),
                   [&](double d) { return d >= 0 && d <= measured.samples; }))
    reject("has delays that are negative or longer than its responses");
  return measured;
}

}  // namespace

// libmysofa checks neither that an array exists nor that it is as long as the dimensions of the file say, and its own
// functions rely on both.
std::string array_fault(const MYSOFA_HRTF& file) {
  if (file.R != 2 || file.C != 3 || file.M < kMinDirections || file.N == 0)
    return "has no impulse responses of two ears in the free field";
  if (file.M > kMaxDirections || file.N > kMaxSamples || std::size_t{2} * file.M * file.N > kMaxResponseValues)
    return "has more directions or longer responses than any measured set";
  if (!has(file.DataIR, std::size_t{2} * file.M * file.N))
    return "has no Data.IR with a value for each of its directions, ears and samples";
  if (!file.DataDelay.values || (file.DataDelay.elements != 2 && file.DataDelay.elements != 2 * file.M))
    return "has no Data.Delay with a value for each ear, or for each direction and ear";
  if (!has(file.SourcePosition, std::size_t{3} * file.M)) return "has no SourcePosition for each of its directions";
  if (!has(file.ReceiverPosition, per_measurement(file.ReceiverPosition) ? std::size_t{6} * file.M : 6))
    return "has no ReceiverPosition for each ear";
  // libmysofa converts these in steps of three values.
  for (const MYSOFA_ARRAY* p : {&file.SourcePosition, &file.ReceiverPosition, &file.ListenerPosition, &file.ListenerView, &file.ListenerUp, &file.EmitterPosition})
    if (p->elements % 3 != 0 || (p->elements > 0 && !p->values)) return "has a position, view or up vector without three coordinates";
  if (!has(file.DataSamplingRate, 1)) return "has no Data.SamplingRate";
  const double rate_Hz = static_cast<double>(file.DataSamplingRate.values[0]);
  if (!(rate_Hz >= kMinRate_Hz && rate_Hz <= kMaxRate_Hz))
    return "has a sampling rate that is not between 8 and 384 kHz";
  return "";
}

MeasuredHrtf parse_sofa(const std::string& path) {
  try {
    sync::check_regular_file(path, kMaxFileBytes);
  } catch (const std::runtime_error& e) {
    reject(std::string("cannot be read: ") + e.what());
  }
  int error = 0;
  const std::unique_ptr<MYSOFA_HRTF, Free> file(mysofa_load(path.c_str(), &error));
  if (!file) reject(error == MYSOFA_READ_ERROR ? "cannot be read" : "is not a SOFA file of impulse responses");
  if (const std::string fault = array_fault(*file); !fault.empty()) reject(fault);
  if (mysofa_check(file.get()) != MYSOFA_OK) reject("has no impulse responses of two ears in the free field");
  mysofa_tocartesian(file.get());
  return measured_of(*file);
}

}  // namespace tactus::audio
