#include "calib/problem/svd.hpp"

template class Eigen::JacobiSVD<Eigen::MatrixXd>;
