#include "sim_node/behaviour/articulated/dynamics.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tactus::sim::articulated {
namespace {

const Eigen::Matrix3d kUpright = Eigen::Matrix3d::Identity();
const Eigen::Vector3d kNowhere = Eigen::Vector3d::Zero();
const Spatial kStill = Spatial::Zero();

}  // namespace

Dynamics::Dynamics(const Tree& tree)
    : tree_(tree),
      work_(tree.links.size()),
      struck_(tree.links.size(), Eigen::Vector3d::Zero()),
      change_(tree.links.size(), Spatial::Zero()) {
  path_.reserve(tree.links.size());
}

void Dynamics::place_link(std::size_t i, const double* positions, const double* rates) {
  const Link& l = tree_.links[i];
  Work& w = work_[i];
  const double* q = positions + l.first_coordinate;
  const double* dq = rates + l.first_dof;
  if (l.def.is_free) {
    w.rotation = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
    w.centre.setZero();
    w.velocity << dq[0], dq[1], dq[2], dq[3], dq[4], dq[5];
    w.bias.setZero();
    return;
  }
  const Work* parent = l.def.parent < 0 ? nullptr : &work_[index(l.def.parent)];
  const Eigen::Matrix3d& before = parent ? parent->rotation : kUpright;
  const Spatial& carrier = parent ? parent->velocity : kStill;
  Eigen::Vector3d anchor = parent ? Eigen::Vector3d(parent->centre + before * l.from_parent_m) : kNowhere;
  const auto hinge = [&](int k, const Eigen::Vector3d& axis) {
    w.axes.col(k) = spatial(axis, anchor.cross(axis));
  };
  switch (l.def.joint) {
    case JointKind::kRevolute: {
      const Eigen::Vector3d axis = before * l.def.axes[0].axis;
      w.rotation.noalias() = rotation_about(axis, q[0]) * before;
      hinge(0, axis);
      w.velocity = carrier + dq[0] * w.axes.col(0);
      w.bias = cross_motion(carrier, dq[0] * w.axes.col(0));
      break;
    }
    case JointKind::kUniversal: {
      const Eigen::Vector3d first = before * l.def.axes[0].axis;
      const Eigen::Matrix3d cross = rotation_about(first, q[0]) * before;
      const Eigen::Vector3d second = cross * l.def.axes[1].axis;
      w.rotation.noalias() = rotation_about(second, q[1]) * cross;
      hinge(0, first);
      hinge(1, second);
      const Spatial between = carrier + dq[0] * w.axes.col(0);
      w.velocity = between + dq[1] * w.axes.col(1);
      w.bias = cross_motion(carrier, dq[0] * w.axes.col(0)) + cross_motion(between, dq[1] * w.axes.col(1));
      break;
    }
    case JointKind::kBall: {
      w.rotation.noalias() = before * Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
      for (int k = 0; k < 3; ++k) hinge(k, w.rotation.col(k));
      const Spatial joint = w.axes * Eigen::Vector3d(dq[0], dq[1], dq[2]);
      w.velocity = carrier + joint;
      w.bias = cross_motion(carrier, joint);
      break;
    }
    case JointKind::kPrismatic: {
      const Eigen::Vector3d axis = before * l.def.axes[0].axis;
      anchor += q[0] * axis;
      w.rotation = before;
      w.axes.col(0) = spatial(kNowhere, axis);
      w.velocity = carrier + dq[0] * w.axes.col(0);
      w.bias = cross_motion(carrier, dq[0] * w.axes.col(0));
      break;
    }
    case JointKind::kFixed:
      w.rotation = before;
      w.velocity = carrier;
      w.bias.setZero();
      break;
  }
  w.centre = anchor + w.rotation * l.to_centre_m;
}

void Dynamics::place(const double* positions, const double* rates) {
  const Link& root = tree_.links[0];
  const double* q = positions + root.first_coordinate;
  origin_ = root.def.is_free ? Eigen::Vector3d(q[0], q[1], q[2]) : root.def.anchor_m;
  for (std::size_t i = 0; i < work_.size(); ++i) place_link(i, positions, rates);
}

void Dynamics::load_link(std::size_t i, const Loads& loads) {
  const LinkDef& d = tree_.links[i].def;
  Work& w = work_[i];
  const Eigen::Matrix3d inertia = w.rotation * d.inertia_kg_m2 * w.rotation.transpose();
  w.inertia = rigid_inertia(d.mass_kg, w.centre, inertia);
  const Eigen::Vector3d spin = w.velocity.head<3>();
  const Eigen::Vector3d speed = w.velocity.tail<3>() + spin.cross(w.centre);
  const Eigen::Vector3d momentum = d.mass_kg * speed, spin_momentum = inertia * spin;
  w.force = cross_force(w.velocity, force_at(w.centre, momentum) + spatial(spin_momentum, kNowhere));
  const Eigen::Vector3d pull = d.mass_kg * d.gravity_m_s2 + loads.force_N[i] - d.linear_damping_1_s * momentum;
  w.force -= force_at(w.centre, pull);
  w.force.head<3>() -= loads.moment_N_m[i] - d.angular_damping_1_s * spin_momentum;
}

void Dynamics::drive_link(std::size_t i, const double* positions, const double* rates, const Loads& loads,
                          const std::vector<char>& passive) {
  const Link& l = tree_.links[i];
  if (l.def.is_free) return;
  for (int k = 0; k < l.dofs; ++k) {
    const std::size_t j = index(l.first_dof + k);
    const Dof& dof = tree_.dofs[j];
    double torque = loads.torque[j];
    if (passive[j]) {
      torque -= dof.damping * rates[j];
      if (dof.stiffness > 0) torque -= dof.stiffness * (positions[dof.coordinate] - dof.reference);
    }
    work_[i].drive[k] = torque;
  }
}

template <int N>
void Dynamics::condense(std::size_t i) {
  Work& w = work_[i];
  const int parent = tree_.links[i].def.parent;
  if constexpr (N == 0) {
    if (parent < 0) return;
    work_[index(parent)].inertia += w.inertia;
    work_[index(parent)].force += w.force;
  } else {
    const auto axes = w.axes.leftCols<N>();
    auto carried = w.carried.leftCols<N>();
    auto shared = w.shared.leftCols<N>();
    carried.noalias() = w.inertia * axes;
    const Eigen::Matrix<double, N, N> stiff = axes.transpose() * carried;
    const Eigen::Matrix<double, N, N> inverse = stiff.inverse();
    w.inverse.topLeftCorner<N, N>() = inverse;
    w.drive.head<N>().noalias() -= axes.transpose() * w.force;
    shared.noalias() = carried * inverse;
    if (parent < 0) return;
    Work& p = work_[index(parent)];
    w.inertia.noalias() -= shared * carried.transpose();
    p.inertia += w.inertia;
    p.force += w.force;
    p.force.noalias() += w.inertia * w.bias;
    p.force.noalias() += shared * w.drive.head<N>();
  }
}

void Dynamics::condense_base() {
  base_inverse_ = work_[0].inertia.llt().solve(Eigen::Matrix<double, 6, 6>::Identity());
}

template <int N>
Spatial Dynamics::respond(std::size_t i, const Spatial& before, const Eigen::Vector3d& drive,
                          double* rates) const {
  const Work& w = work_[i];
  const Eigen::Matrix<double, N, 1> missing = drive.head<N>() - w.carried.leftCols<N>().transpose() * before;
  const Eigen::Matrix<double, N, 1> rate = w.inverse.topLeftCorner<N, N>() * missing;
  if (rates)
    for (int k = 0; k < N; ++k) rates[k] = rate[k];
  return before + w.axes.leftCols<N>() * rate;
}

// Response of a joint and its link to the parent's motion `before` and the force `drive` along the joint.
Spatial Dynamics::respond_link(std::size_t i, const Spatial& before, const Eigen::Vector3d& drive,
                               double* rates) const {
  switch (tree_.links[i].dofs) {
    case 1: return respond<1>(i, before, drive, rates);
    case 2: return respond<2>(i, before, drive, rates);
    case 3: return respond<3>(i, before, drive, rates);
    default: return before;
  }
}

void Dynamics::evaluate(const double* positions, const double* rates, const Loads& loads,
                        const std::vector<char>& passive, double* accelerations) {
  place(positions, rates);
  for (std::size_t i = 0; i < work_.size(); ++i) {
    load_link(i, loads);
    drive_link(i, positions, rates, loads, passive);
  }
  for (std::size_t i = work_.size(); i-- > 0;) {
    switch (tree_.links[i].dofs) {
      case 1: condense<1>(i); break;
      case 2: condense<2>(i); break;
      case 3: condense<3>(i); break;
      case 6: condense_base(); break;
      default: condense<0>(i); break;
    }
  }
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const Link& l = tree_.links[i];
    Work& w = work_[i];
    double* out = accelerations + l.first_dof;
    if (l.def.is_free) {
      w.acceleration.noalias() = -(base_inverse_ * w.force);
      // A spatial acceleration belongs to the body point at the common point. The acceleration of the link's own
      // point has an additional term.
      const Eigen::Vector3d own =
          w.acceleration.tail<3>() + w.velocity.head<3>().cross(Eigen::Vector3d(w.velocity.tail<3>()));
      for (int k = 0; k < 3; ++k) out[k] = w.acceleration[k], out[3 + k] = own[k];
      continue;
    }
    const Spatial& before = l.def.parent < 0 ? kStill : work_[index(l.def.parent)].acceleration;
    w.acceleration = respond_link(i, before + w.bias, w.drive, out);
  }
}

// Inward pass along the path from the link: each joint takes its share and passes the rest to the parent.
void Dynamics::propagate_inward(int link, Spatial force) {
  for (int i = link; i >= 0; i = tree_.links[index(i)].def.parent) {
    const Work& w = work_[index(i)];
    switch (tree_.links[index(i)].dofs) {
      case 1: {
        struck_[index(i)][0] += w.axes.col(0).dot(force);
        force -= w.shared.col(0) * w.axes.col(0).dot(force);
        break;
      }
      case 2: {
        const Eigen::Vector2d share = w.axes.leftCols<2>().transpose() * force;
        struck_[index(i)].head<2>() += share;
        force.noalias() -= w.shared.leftCols<2>() * share;
        break;
      }
      case 3: {
        const Eigen::Vector3d share = w.axes.transpose() * force;
        struck_[index(i)] += share;
        force.noalias() -= w.shared * share;
        break;
      }
      case 6: base_struck_ += force; break;
      default: break;
    }
  }
}

// Outward pass over all links. Clears the forces that the inward pass propagated.
void Dynamics::propagate_outward(std::span<double> rates) {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    const Link& l = tree_.links[i];
    if (l.def.is_free) {
      change_[0].noalias() = base_inverse_ * base_struck_;
      for (std::size_t k = 0; k < 6; ++k) rates[k] = change_[0][static_cast<int>(k)];
      base_struck_.setZero();
      continue;
    }
    const Spatial& before = l.def.parent < 0 ? kStill : change_[index(l.def.parent)];
    change_[i] = respond_link(i, before, struck_[i], rates.data() + l.first_dof);
    struck_[i].setZero();
  }
}

void Dynamics::impulse_to_rates(int link, const Eigen::Vector3d& point_m, const Eigen::Vector3d& impulse,
                                std::span<double> rates) {
  propagate_inward(link, force_at(point_m - origin_, impulse));
  propagate_outward(rates);
}

void Dynamics::angular_impulse_to_rates(int link, const Eigen::Vector3d& impulse, std::span<double> rates) {
  Spatial couple = Spatial::Zero();
  couple.head<3>() = impulse;
  propagate_inward(link, couple);
  propagate_outward(rates);
}

void Dynamics::dof_impulse_to_rates(int dof, std::span<double> rates) {
  const int link = tree_.dofs[index(dof)].link;
  const Link& l = tree_.links[index(link)];
  const int k = dof - l.first_dof;
  if (l.def.is_free) {
    base_struck_[k] = 1;
  } else {
    struck_[index(link)][k] = 1;
    if (l.def.parent >= 0) propagate_inward(l.def.parent, -work_[index(link)].shared.col(k));
  }
  propagate_outward(rates);
}

Eigen::Matrix3d Dynamics::response(int to_link, const Eigen::Vector3d& to_m, int from_link,
                                   const Eigen::Vector3d& from_m) {
  path_.clear();
  for (int i = to_link; i >= 0; i = tree_.links[index(i)].def.parent) path_.push_back(i);
  Eigen::Matrix3d out;
  for (int k = 0; k < 3; ++k) {
    propagate_inward(from_link, force_at(from_m - origin_, Eigen::Vector3d::Unit(k)));
    Spatial change = kStill;
    for (auto i = path_.rbegin(); i != path_.rend(); ++i)
      change = tree_.links[index(*i)].def.is_free ? Spatial(base_inverse_ * base_struck_)
                                                  : respond_link(index(*i), change, struck_[index(*i)], nullptr);
    out.col(k) = change.tail<3>() + Eigen::Vector3d(change.head<3>()).cross(to_m - origin_);
    for (int i = from_link; i >= 0; i = tree_.links[index(i)].def.parent) struck_[index(i)].setZero();
    base_struck_.setZero();
  }
  return out;
}

void Dynamics::jacobian(int link, const Eigen::Vector3d& point_m, std::span<double> rows) const {
  std::fill(rows.begin(), rows.end(), 0.0);
  const std::size_t n = tree_.dofs.size();
  const Eigen::Vector3d arm = point_m - origin_;
  for (int i = link; i >= 0; i = tree_.links[index(i)].def.parent) {
    const Link& l = tree_.links[index(i)];
    for (int k = 0; k < l.dofs; ++k) {
      const Spatial axis = l.def.is_free ? Spatial(Spatial::Unit(k)) : Spatial(work_[index(i)].axes.col(k));
      const Eigen::Vector3d speed = axis.tail<3>() + Eigen::Vector3d(axis.head<3>()).cross(arm);
      for (std::size_t r = 0; r < 3; ++r) rows[r * n + index(l.first_dof + k)] = speed[static_cast<int>(r)];
    }
  }
}

}  // namespace tactus::sim::articulated
