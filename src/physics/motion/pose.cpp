#include "physics/motion/pose.hpp"

#include <Eigen/SVD>

namespace weft::motion {

std::optional<Vec3> change_of_angles(const Pose& from, const Pose& to) {
  const auto angles = [](const Pose& pose) {
    return !pose.angles && pose.rotation.coeffs() == Quat::Identity().coeffs() ? Vec3(Vec3::Zero()) : pose.angles;
  };
  const std::optional<Vec3> first = angles(from), last = angles(to);
  return first && last ? std::optional<Vec3>(*last - *first) : std::nullopt;
}

Mat3 best_rotation(const Mat3& matrix) {
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 no_mirror = Mat3::Identity();
  no_mirror(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * no_mirror * svd.matrixV().transpose();
}

}  // namespace weft::motion
