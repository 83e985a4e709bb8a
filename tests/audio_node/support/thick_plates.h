// Thick plates, computed independently of audio_node/modal: free plates by the equations of Mindlin (J. Appl. Mech. 18, 1951) and the
// method of Ritz, supported ones by three-dimensional elasticity.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "audio_node/modal/modal.h"

namespace tactus::audio::test {

// The lowest natural frequencies of a free plate a by b, Hz, without the three rigid motions; kappa = 5/6. Deflection and rotations are sums
// of products of `order` Legendre polynomials. With nine the lowest five are high by less than 1 % for a up to 2.5 b.
inline std::vector<double> free_mindlin_plate(const Elastic& m, double a_m, double b_m, double h, std::size_t count) {
  constexpr int kOrder = 9, kSize = kOrder * kOrder;
  using Eigen::MatrixXd;
  // Integrals over -1 .. 1 of P_i P_k, P_i' P_k and P_i' P_k'.
  MatrixXd values = MatrixXd::Zero(kOrder, kOrder), mixed = values, slopes = values;
  for (int i = 0; i < kOrder; ++i)
    for (int k = 0; k < kOrder; ++k) {
      const int least = std::min(i, k);
      if (i == k) values(i, k) = 2.0 / (2 * i + 1);
      if (i > k && (i - k) % 2) mixed(i, k) = 2;
      if ((i + k) % 2 == 0) slopes(i, k) = least * (least + 1);
    }
  const auto product = [&](const MatrixXd& x, const MatrixXd& y) {
    MatrixXd out(kSize, kSize);
    for (int i = 0; i < kOrder; ++i)
      for (int k = 0; k < kOrder; ++k) out.block<kOrder, kOrder>(i * kOrder, k * kOrder) = x(i, k) * y;
    return out;
  };
  const double jx = a_m / 2, jy = b_m / 2, nu = m.poissons_ratio;
  const double D = m.youngs_modulus_Pa * h * h * h / (12 * (1 - nu * nu)), twist = D * (1 - nu) / 2;
  const double shear = 5 / 6. * m.youngs_modulus_Pa / (2 * (1 + nu)) * h;
  const MatrixXd all = product(values, values) * jx * jy, xx = product(slopes, values) / jx * jy,
                 yy = product(values, slopes) * jx / jy, xy = product(mixed, mixed.transpose()),
                 x0 = product(mixed, values) * jy, y0 = product(values, mixed) * jx;
  MatrixXd K = MatrixXd::Zero(3 * kSize, 3 * kSize), M = K;
  const auto put = [&](int i, int k, const MatrixXd& part) {
    K.block<kSize, kSize>(i * kSize, k * kSize) = part;
    K.block<kSize, kSize>(k * kSize, i * kSize) = part.transpose();
  };
  put(0, 0, shear * (xx + yy)), put(0, 1, shear * x0), put(0, 2, shear * y0);
  put(1, 1, D * xx + twist * yy + shear * all), put(2, 2, D * yy + twist * xx + shear * all);
  put(1, 2, nu * D * xy + twist * xy.transpose());
  for (int i = 0; i < 3; ++i)
    M.block<kSize, kSize>(i * kSize, i * kSize) = m.density_kg_m3 * (i == 0 ? h : h * h * h / 12) * all;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solved(K, M, Eigen::EigenvaluesOnly);
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(std::sqrt(solved.eigenvalues()[static_cast<Eigen::Index>(i) + 3]) / (2 * M_PI));
  return out;
}

// Lowest antisymmetric wave of wavenumber k in a plate of any thickness, Hz (Rayleigh and Lamb; Graff, Wave Motion in Elastic Solids,
// 1975, section 8.1): tanh(q d) / tanh(p d) = (q^2 + k^2)^2 / (4 k^2 p q), d = h / 2. A plate whose edges are simply supported vibrates
// with exactly these waves.
inline double lamb_wave_Hz(const Elastic& m, double h, double k) {
  const double ct = shear_speed_m_s(m), nu = m.poissons_ratio, cl = ct * std::sqrt(2 * (1 - nu) / (1 - 2 * nu));
  const auto left = [&](double w) {
    const double p = std::sqrt(k * k - w * w / (cl * cl)), q = std::sqrt(k * k - w * w / (ct * ct));
    return 4 * k * k * p * q * std::tanh(q * h / 2) - (q * q + k * k) * (q * q + k * k) * std::tanh(p * h / 2);
  };
  // Positive below the wave, negative above it. The wave is slower than shear waves.
  double low = 1e-6 * k * ct, high = (1 - 1e-9) * k * ct;
  const bool sign = left(low) < 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    ((left(middle) < 0) == sign ? low : high) = middle;
  }
  return low / (2 * M_PI);
}

}  // namespace tactus::audio::test
