// Fractal roughness of a surface below the resolution of its map. It is fixed in the surface, so that the same
// place sounds the same in every run. Pure.
//
// Heights h(p) = sum over octaves k and three orthogonal directions d_j of a_k n_jk(d_j . p / l_k), where n
// interpolates smoothly between hashed numbers, l_k halves and a_k falls with 2^(-k H): along any line the
// spectrum of heights falls as 1/f^(2 H + 1).
#pragma once

#include <Eigen/Core>

namespace tactus::audio {

// Hurst exponent: 0.8 for most ground, blasted or broken surfaces (Persson et al. 2005, J. Phys.: Condens. Matter
// 17 R1, section 2; fracture: Bouchaud 1997, J. Phys.: Condens. Matter 9, p. 4319).
inline constexpr double kHurst = 0.8;

struct Roughness {
  double height_m = 0;  // root mean square, of waves up to 0.8 mm
  // Pixel size of the map, which holds the waves longer than two pixels; 0: no map.
  double texel_m = 0;
};

// Places on a surface in the frame of its body, m: for each sample n, p + n step + n^2 bend.
struct Track {
  Eigen::Vector3d p, step, bend;
  Eigen::Vector3d at(double n) const { return p + n * (step + n * bend); }
};

// Adds, for each sample, the slope of the roughness along two directions. Omits waves that these samples cannot
// represent. Realtime-safe: yes.
void add_slopes(const Roughness& of, const Track& track, const Eigen::Vector3f& along,
                const Eigen::Vector3f& along_other, int frames, float* slope, float* slope_other);

// Mean square of the slope along any line, over all waves.
double mean_square_slope(const Roughness& of);

}  // namespace tactus::audio
