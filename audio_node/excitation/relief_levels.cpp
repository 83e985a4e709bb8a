#include "audio_node/excitation/relief_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::audio {
namespace {

// Reduces rows of n values to `fewer` values, each the mean over the covered pixels; rows lie one after the other.
std::vector<float> downsampled(const std::vector<float>& from, int n, int fewer, int count, int stride, int next) {
  std::vector<float> to(static_cast<std::size_t>(fewer) * static_cast<std::size_t>(count));
  const double wide = static_cast<double>(n) / fewer;
  for (int c = 0; c < count; ++c)
    for (int i = 0; i < fewer; ++i) {
      double sum = 0;
      for (int k = static_cast<int>(i * wide); k < n && k < (i + 1) * wide; ++k)
        sum += (std::min(k + 1.0, (i + 1) * wide) - std::max(static_cast<double>(k), i * wide)) *
               static_cast<double>(from[static_cast<std::size_t>(k * stride + c * next)]);
      const int place = stride == 1 ? c * fewer + i : i * count + c;
      to[static_cast<std::size_t>(place)] = static_cast<float>(sum / wide);
    }
  return to;
}

Relief half_resolution(const Relief& r) {
  Relief out;
  out.size_m = r.size_m;
  out.columns = (r.columns + 1) / 2, out.rows = (r.rows + 1) / 2;
  const auto narrow = downsampled(r.heights_m, r.columns, out.columns, r.rows, 1, r.columns);
  out.heights_m = downsampled(narrow, r.rows, out.rows, out.columns, out.columns, 1);
  const auto height = [&](int column, int row) {
    column = (column + out.columns) % out.columns, row = (row + out.rows) % out.rows;
    return out.heights_m[static_cast<std::size_t>(row * out.columns + column)];
  };
  const float along_u = static_cast<float>(out.columns) / (2 * r.size_m.x());
  const float along_v = static_cast<float>(out.rows) / (2 * r.size_m.y());
  for (int row = 0; row < out.rows; ++row)
    for (int column = 0; column < out.columns; ++column)
      out.slopes.emplace_back(along_u * (height(column + 1, row) - height(column - 1, row)),
                              along_v * (height(column, row + 1) - height(column, row - 1)));
  return out;
}

}  // namespace

ReliefLevels::ReliefLevels(Relief finest) {
  levels_.push_back(std::move(finest));
  while (levels_.back().columns > 1 || levels_.back().rows > 1) levels_.push_back(half_resolution(levels_.back()));
}

Eigen::Vector2d ReliefLevels::slope(const Eigen::Vector2d& at, const Eigen::Vector2d& step) const {
  const Relief& fine = levels_.front();
  const double pixels = std::max(std::abs(step.x()) * fine.columns, std::abs(step.y()) * fine.rows);
  // The shortest wave of a grid is two pixels long, and two samples represent it: above one pixel per sample the
  // next grid is used.
  if (!(pixels > 1)) return fine.slope(at);
  const double level = std::min(std::log2(pixels), static_cast<double>(levels_.size() - 1));
  const auto k = static_cast<std::size_t>(level);
  const double part = level - static_cast<double>(k);
  const Eigen::Vector2d slope = levels_[k].slope(at);
  return part > 0 ? Eigen::Vector2d(slope + part * (levels_[k + 1].slope(at) - slope)) : slope;
}

double ReliefLevels::texel_m() const {
  const Relief& fine = levels_.front();
  return std::min(static_cast<double>(fine.size_m.x()) / fine.columns,
                  static_cast<double>(fine.size_m.y()) / fine.rows);
}

}  // namespace tactus::audio
