// Eight oriented boxes in structure-of-arrays layout for one overlap test. Plain data: compiled for several
// instruction sets, so it must not include anything that the linker could share between them.
#pragma once

namespace tactus::sim {

inline constexpr int kLanes = 8;

// Boxes in the frame of their tree, m. Rounded to float; tests must add slack for the rounding.
struct alignas(64) WideNode {
  float centre[3][kLanes];
  float axis[3][3][kLanes];  // [i][k]: component k of axis i, unit
  float half[3][kLanes];     // along axis i
  float size[kLanes];        // norm of the half extents
  int child[kLanes];         // a node, or ~triangle
  int count;                 // lanes in use, from the first
};

// A box in the frame of the other tree, already enlarged.
struct BoxQuery {
  float centre[3];
  float axis[3][3];  // [j][k]: component k of axis j
  float half[3];
  float grow;   // enlargement of each box of the node along its own axes, m
  float slack;  // bound of the rounding errors of the test, m
};

// Bit i is set when box i of the node may overlap the query. Conservative (Gottschalk 1996: 15 separating axes).
using OverlapTest = unsigned (*)(const WideNode&, const BoxQuery&);
unsigned overlap_baseline(const WideNode&, const BoxQuery&);
unsigned overlap_avx2(const WideNode&, const BoxQuery&);
unsigned overlap_avx512(const WideNode&, const BoxQuery&);

}  // namespace tactus::sim
