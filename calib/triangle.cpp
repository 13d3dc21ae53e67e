#include "calib/triangle.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace rigcal::calib {

void Triangle::add(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  const Eigen::Index columns = triangle_.cols();
  for (Eigen::Index first = 0; first < rows.rows(); first += kBlock) {
    const Eigen::Index count = std::min(kBlock, rows.rows() - first);
    Eigen::MatrixXd stacked(columns + count, columns);
    stacked.topRows(columns) = triangle_;
    stacked.bottomRows(count) = rows.middleRows(first, count);
    const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(stacked);
    triangle_ = stacked.topRows(columns).triangularView<Eigen::Upper>();
  }
}

}  // namespace rigcal::calib
