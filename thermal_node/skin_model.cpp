#include "thermal_node/skin_model.h"

#include <algorithm>
#include <cmath>

#include "thermal_node/tridiagonal.h"

namespace tactus::thermal {
namespace {

// Grid in s^0.5: the surface cell resolves changes of (0.02)^2 s = 0.4 ms; 56 cells that grow by 12 % reach 95
// s^0.5, which heat passes in about (95/2)^2 s = 2000 s, so the far end is never felt.
constexpr double kFirstCell = 0.02;
constexpr double kGrowth = 1.12;
constexpr double kMostSubsteps = 2000;
// Alexander 1977, two stages: gamma = 1 - 1/sqrt(2).
constexpr double kGamma = 0.29289321881345254;

// Widths of the cells of one side, surface first, and 1/distance between the centres of cells i and i + 1.
template <std::size_t N>
struct Grid {
  std::array<double, N> width{};
  std::array<double, N> link{};
  constexpr Grid() {
    double w = kFirstCell;
    for (double& cell : width) {
      cell = w;
      w *= kGrowth;
    }
    for (std::size_t i = 0; i + 1 < N; ++i) link[i] = 2 / (width[i] + width[i + 1]);
  }
};

}  // namespace

void SkinModel::reset() {
  u_.fill(0);
  surface_K_ = flux_ = 0;
  set_object(object_);
}

void SkinModel::set_object(const ObjectProperties& object) {
  object_ = object;
  std::fill(u_.begin() + kSide, u_.end(), object.rest_degC - skin_.rest_degC);
}

// The surface itself holds no heat: what comes through the half cell of skin goes to the object and to the room.
// With g_skin, g_contact, g_room the conductances from the surface to the skin's first cell u, to the object's
// first cell v and to the room: surface = (g_skin u + g_contact v)/sum.
SkinModel::Surface SkinModel::surface(double conductance_W_m2K, double touched_share) const {
  const double g_skin = 2 * skin_.effusivity / kFirstCell;
  const double g_object = 2 * object_.effusivity / kFirstCell;
  const double g_contact = conductance_W_m2K > 0 && g_object > 0 ? 1 / (1 / conductance_W_m2K + 1 / g_object) : 0;
  const double g_room = skin_.air_conductance_W_m2K * (1 - touched_share);
  const double sum = g_skin + g_contact + g_room;
  return {g_skin * g_contact / sum, g_skin * g_room / sum, g_contact * (g_skin + g_room) / sum, g_skin / sum,
          g_contact / sum};
}

SkinModel::Equations SkinModel::equations(const Surface& surface) const {
  static constexpr Grid<kSide> grid;
  Equations e;
  for (std::size_t i = 0; i + 1 < kSide; ++i) {
    // Cell i of either side with its deeper neighbour.
    const double near = grid.link[i] / grid.width[i], far = grid.link[i] / grid.width[i + 1];
    const std::size_t skin = kSide - 1 - i, object = kSide + i;
    e.centre[skin] -= near, e.lower[skin] += near, e.centre[skin - 1] -= far, e.upper[skin - 1] += far;
    e.centre[object] -= near, e.upper[object] += near, e.centre[object + 1] -= far, e.lower[object + 1] += far;
  }
  for (std::size_t i = 0; i < kSide; ++i) e.centre[i] -= skin_.perfusion_1_s;
  const double skin_capacity = skin_.effusivity * kFirstCell, object_capacity = object_.effusivity * kFirstCell;
  e.centre[kSide - 1] -= (surface.to_object + surface.to_room) / skin_capacity;
  e.upper[kSide - 1] += surface.to_object / skin_capacity;
  if (object_capacity > 0) {
    e.lower[kSide] += surface.to_object / object_capacity;
    e.centre[kSide] -= surface.from_object / object_capacity;
  }
  return e;
}

SkinModel::Cells SkinModel::solve(const Equations& e, double factor, Cells right) {
  Cells lower, centre, upper, scratch;
  for (std::size_t i = 0; i < kCells; ++i) {
    lower[i] = -factor * e.lower[i];
    centre[i] = 1 - factor * e.centre[i];
    upper[i] = -factor * e.upper[i];
  }
  solve_tridiagonal(lower, centre, upper, right, scratch);
  return right;
}

void SkinModel::substep(double dt_s, const Equations& e, const Surface& s) {
  const auto to_object = [&](const Cells& u) { return s.to_object * u[kSide - 1] - s.from_object * u[kSide]; };
  const Cells first = solve(e, kGamma * dt_s, u_);
  Cells right;
  for (std::size_t i = 0; i < kCells; ++i) right[i] = u_[i] + (1 - kGamma) / kGamma * (first[i] - u_[i]);
  u_ = solve(e, kGamma * dt_s, right);
  flux_ = (1 - kGamma) * to_object(first) + kGamma * to_object(u_);
}

void SkinModel::step(double dt_s, double conductance_W_m2K, double touched_share, double longest_substep_s) {
  const Surface s = surface(conductance_W_m2K, std::clamp(touched_share, 0.0, 1.0));
  if (dt_s > 0) {
    const Equations e = equations(s);
    const double count = std::clamp(std::ceil(dt_s / longest_substep_s), 1.0, kMostSubsteps);
    for (int i = 0; i < static_cast<int>(count); ++i) substep(dt_s / count, e, s);
  }
  surface_K_ = s.weight_skin * u_[kSide - 1] + s.weight_object * u_[kSide];
}

}  // namespace tactus::thermal
