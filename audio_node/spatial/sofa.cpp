#include "audio_node/spatial/sofa.h"

#include <mysofa.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace tactus::audio {
namespace {

constexpr double kSameDistance_m = 0.01;
constexpr unsigned kMinDirections = 4;  // minimum to surround a head

struct Free {
  void operator()(MYSOFA_HRTF* file) const { mysofa_free(file); }
};

[[noreturn]] void reject(const std::string& path, const std::string& why) {
  throw std::runtime_error("the HRTF file " + path + " " + why + "; choose another hrtf_file");
}

Eigen::Vector3d position(const MYSOFA_HRTF& file, std::size_t i) {
  const float* p = file.SourcePosition.values + 3 * i;
  return Eigen::Vector3f(p[0], p[1], p[2]).cast<double>();
}

}  // namespace

MeasuredHrtf load_sofa(const std::string& path) {
  int error = 0;
  const std::unique_ptr<MYSOFA_HRTF, Free> file(mysofa_load(path.c_str(), &error));
  if (!file) reject(path, error == MYSOFA_READ_ERROR ? "cannot be read" : "is not a SOFA file of impulse responses");
  if (mysofa_check(file.get()) != MYSOFA_OK || file->R != 2 || file->M < kMinDirections ||
      !(file->DataSamplingRate.values[0] > 0))
    reject(path, "has no impulse responses of two ears in the free field");
  mysofa_tocartesian(file.get());
  // AES69: the receivers of SimpleFreeFieldHRIR are left and right; the receiver positions show if a file swaps
  // them.
  const bool turned = file->ReceiverPosition.elements >= 6 && file->ReceiverPosition.values[1] < 0;
  double far_m = 0;
  for (std::size_t i = 0; i < file->M; ++i) far_m = std::max(far_m, position(*file, i).norm());

  MeasuredHrtf measured;
  measured.rate_Hz = static_cast<double>(file->DataSamplingRate.values[0]);
  measured.samples = static_cast<int>(file->N);
  for (std::size_t i = 0; i < file->M; ++i) {
    const Eigen::Vector3d at = position(*file, i);
    if (!(at.norm() > far_m - kSameDistance_m)) continue;
    measured.directions.push_back(at.normalized());
    for (std::size_t ear = 0; ear < 2; ++ear) {
      const std::size_t receiver = turned ? 1 - ear : ear;
      const float* from = file->DataIR.values + (2 * i + receiver) * file->N;
      measured.responses.insert(measured.responses.end(), from, from + file->N);
      const bool each = file->DataDelay.elements == 2 * file->M;
      measured.delays.push_back(static_cast<double>(file->DataDelay.values[(each ? 2 * i : 0) + receiver]));
    }
  }
  const auto finite = [](float x) { return std::isfinite(x); };
  if (!std::all_of(measured.responses.begin(), measured.responses.end(), finite))
    reject(path, "has values that are not finite");
  if (!std::all_of(measured.delays.begin(), measured.delays.end(),
                   [&](double d) { return d >= 0 && d <= measured.samples; }))
    reject(path, "has delays that are negative or longer than its responses");
  return measured;
}

}  // namespace tactus::audio
