#include "film/character/mannequin_skin.hpp"

#include <algorithm>
#include <functional>

namespace weft::character {
namespace {

using Weights = std::array<double, kJointCount>;

/// max(x, 0), with a corner that is rounded over the length `round`.
double positive_part(double x, double round) {
  if (x <= 0) return 0;
  return x < round ? x * x / (2 * round) : x - round / 2;
}

/// Computes the skinning weights at one point of the left half. Starts with all weight on the hips and moves it
/// outward, joint by joint. Lengths are in centimetres for a body height of 175 cm, as in the tables of
/// mannequin_shape.cpp.
class WeightBlender {
 public:
  WeightBlender(const std::array<Vec3, kJointCount>& joints, double height, const Vec3& p)
      : joints_(joints), cm_(height / 175), x_(p.x() / cm_), forward_(-p.y() / cm_), up_(p.z() / cm_), p_(p) {
    weight_.fill(0);
    weight_[joint_index(Joint::hips)] = 1;
  }

  Weights compute() {
    torso_and_head();
    arm();
    legs();
    keep_four_largest();
    return weight_;
  }

 private:
  const Vec3& at(Joint joint) const { return joints_[joint_index(joint)]; }

  /// Moves the fraction `s` of the weight of `from` to `to`.
  void transfer(Joint from, Joint to, double s) {
    weight_[joint_index(to)] += s * weight_[joint_index(from)];
    weight_[joint_index(from)] *= 1 - s;
  }

  void torso_and_head() {
    transfer(Joint::hips, Joint::spine, smooth_ramp(up_, 97, 114));
    transfer(Joint::spine, Joint::chest, smooth_ramp(up_, 111, 128));
    // The shoulders keep their weight on the chest.
    transfer(Joint::chest, Joint::neck, smooth_ramp(up_, 141.5, 151.5) * (1 - smooth_ramp(x_, 4.5, 9)));
    // The chin follows the head; the nape at the same height follows the neck.
    transfer(Joint::neck, Joint::head, smooth_ramp(up_ + 0.5 * (forward_ - 1), 151, 158.5));
  }

  void arm() {
    const Vec3 along = (at(Joint::left_hand) - at(Joint::left_upper_arm)).normalized();
    const Vec3 out(-along.z(), 0, along.x());  // away from the body
    const Vec3 from_shoulder = (p_ - at(Joint::left_upper_arm)) / cm_;
    const double s = from_shoulder.dot(along);
    // Skin of the flank can be as far along the arm's axis as skin of the arm, but it is closer to the middle of the
    // body. `depth` is smaller there, to distinguish both.
    const double depth = s - 1.6 * positive_part(-from_shoulder.dot(out) - 2, 2);
    const double clavicle = smooth_ramp(x_, 2, 13) * smooth_ramp(up_, 126, 141);
    const double arm = smooth_ramp(depth, -7.5, 7.5);
    transfer(Joint::chest, Joint::left_shoulder, clavicle);
    for (const Joint joint : {Joint::hips, Joint::spine, Joint::chest, Joint::neck, Joint::left_shoulder}) {
      transfer(joint, Joint::left_upper_arm, arm);
    }
    const double elbow = (at(Joint::left_lower_arm) - at(Joint::left_upper_arm)).norm() / cm_;
    const double wrist = (at(Joint::left_hand) - at(Joint::left_upper_arm)).norm() / cm_;
    transfer(Joint::left_upper_arm, Joint::left_lower_arm, smooth_ramp(s, elbow - 6, elbow + 6));
    transfer(Joint::left_lower_arm, Joint::left_hand, smooth_ramp(s, wrist - 4, wrist + 4));
  }

  void legs() {
    // The fold of the groin is higher toward the side. At the back, the transition from hips to thigh is longer.
    const double behind = smooth_ramp(-forward_, -4, 6);
    const double fold = 86.5 + 0.3 * (x_ - 9) - 2 * behind, half = 7.5 + 2 * behind;
    const double leg = smooth_ramp(fold - up_, -half, half);
    // Vertices between the legs get weight on both legs.
    const double bridge = 0.6 + 3.5 * smooth_ramp(up_, 71, 80);
    const double left = smooth_ramp(x_, -bridge, bridge);
    const double leg_weight = weight_[joint_index(Joint::hips)] * leg;
    weight_[joint_index(Joint::hips)] -= leg_weight;
    weight_[joint_index(Joint::left_upper_leg)] += left * leg_weight;
    weight_[joint_index(Joint::right_upper_leg)] += (1 - left) * leg_weight;

    const double knee = at(Joint::left_lower_leg).z() / cm_;
    transfer(Joint::left_upper_leg, Joint::left_lower_leg, smooth_ramp(-up_, -knee - 7, -knee + 7));
    // The instep follows the foot up to the ankle joint.
    const double foot = up_ - 0.8 * positive_part(forward_ + 1.3, 2);
    transfer(Joint::left_lower_leg, Joint::left_foot, smooth_ramp(-foot, -12.5, -4.5));
    const Vec3 axis = (at(Joint::left_toes) - at(Joint::left_foot)).cwiseProduct(Vec3(1, 1, 0));
    const double t = (p_ - at(Joint::left_foot)).dot(axis.normalized()) / cm_, ball = axis.norm() / cm_;
    // The transition to the toes is wider on top, because skin there is farther from the joint and would fold.
    const double half_bend = 1.8 + 0.9 * up_;
    transfer(Joint::left_foot, Joint::left_toes, smooth_ramp(t, ball - half_bend, ball + half_bend));
  }

  void keep_four_largest() {
    Weights sorted = weight_;
    std::nth_element(sorted.begin(), sorted.begin() + 3, sorted.end(), std::greater<>());
    const double threshold = std::max(sorted[3], 1e-4);
    double sum = 0;
    for (double& w : weight_) sum += w = w < threshold ? 0 : w;
    for (double& w : weight_) w /= sum;
  }

  const std::array<Vec3, kJointCount>& joints_;
  double cm_, x_, forward_, up_;
  Vec3 p_;
  Weights weight_{};
};

}  // namespace

double smooth_ramp(double x, double low, double high) {
  const double s = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

std::array<double, kJointCount> mannequin_weights(const std::array<Vec3, kJointCount>& joints, double height,
                                                  const Vec3& p) {
  return WeightBlender(joints, height, p).compute();
}

}  // namespace weft::character
