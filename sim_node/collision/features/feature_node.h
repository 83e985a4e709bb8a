// Eight boxes of features (faces, edges or vertices) in structure-of-arrays layout, with the directions in which
// their nearest points can lie, for one test. Plain data: compiled for several instruction sets, so it must not
// include anything that the linker could share between them.
#pragma once

#include "sim_node/collision/layers/wide_node.h"

namespace tactus::sim::features {

// Boxes in the frame of their tree, m. Rounded to float; tests must add slack for the rounding.
struct alignas(64) FeatureNode {
  float centre[3][kLanes];
  float axis[3][3][kLanes];  // [i][k]: component k of axis i, unit; axis 2 is the nearest to the directions
  float half[3][kLanes];     // along axis i
  float slope[3][kLanes];    // largest component along axis i of a direction in which a nearest point can lie
  float per_rise[kLanes];    // inverse of the least component along axis 2; 1e9 where that is below a tenth
  float cone[3][kLanes];     // axis of the double cone that contains the directions, unit
  float cosine[kLanes], sine[kLanes];  // of its half angle; 0 and 1: all directions
  float size[kLanes];                  // norm of the half extents
  int child[kLanes];                   // a node, or ~feature
  int count;                           // lanes in use, from the first
  unsigned inner;                      // bit i is set when child i is a node
};

// A point, a segment or a ball around several of them in the frame of the other tree.
struct FeatureQuery {
  float centre[3];
  float along[3];  // half of a segment; 0 for a point or a ball
  float radius;    // of a ball; else 0
  float size;      // radius, or half the length of the segment
  float reach, slack;
  float cone[3];  // of the directions to the other surface, as in FeatureNode
  float cosine, sine;
};

// Bit i is set when a feature in box i may lie within reach of the query, in a direction that both allow.
// Conservative.
using ReachTest = unsigned (*)(const FeatureNode&, const FeatureQuery&);
unsigned reach_baseline(const FeatureNode&, const FeatureQuery&);
unsigned reach_avx2(const FeatureNode&, const FeatureQuery&);
unsigned reach_avx512(const FeatureNode&, const FeatureQuery&);

// The edges of the leaves of a node; the centres are those of the node.
struct alignas(64) EdgeLanes {
  float along[3][kLanes];      // unit
  float half[kLanes];          // half the length, m
  float inward[2][3][kLanes];  // of the two faces, unit; 0: no face
};

struct EdgeQuery {
  float centre[3], along[3], half;
  float inward[2][3];
  float reach, slack;
};

// Bit i is set when the lines of the two edges may be nearest between their ends, within reach, and on the outer
// side of all faces. Nearly parallel edges pass. Conservative.
using EdgeTest = unsigned (*)(const FeatureNode&, const EdgeLanes&, const EdgeQuery&);
unsigned cross_baseline(const FeatureNode&, const EdgeLanes&, const EdgeQuery&);
unsigned cross_avx2(const FeatureNode&, const EdgeLanes&, const EdgeQuery&);
unsigned cross_avx512(const FeatureNode&, const EdgeLanes&, const EdgeQuery&);

}  // namespace tactus::sim::features
