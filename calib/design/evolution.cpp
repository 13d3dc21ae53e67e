#include "calib/design/evolution.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace rigcal::calib {
namespace {

constexpr double kRandomShare = 1.0 / 3.0;
constexpr double kFirstWidth = 0.2;  // fraction of the box

/// Reflects a point at the faces of the unit box as often as needed.
Eigen::VectorXd reflected(const Eigen::VectorXd& point) {
  return point.unaryExpr([](double x) {
    const double within = x - 2.0 * std::floor(0.5 * x);
    return within > 1.0 ? 2.0 - within : within;
  });
}

Eigen::VectorXd random_direction(Eigen::Index n, datasets::RandomStream& stream) {
  Eigen::VectorXd direction(n);
  for (double& each : direction) each = datasets::normal(stream, 1.0);
  return direction;
}

/// Returns the indices of the points from best to worst. Points with equal scores keep their order.
std::vector<std::size_t> ranked(const std::vector<double>& scores) {
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  return order;
}

/// The search distribution, in Hansen's notation and with his default constants.
class Strategy {
 public:
  explicit Strategy(Eigen::VectorXd mean)
      : n_(mean.size()),
        mean_(std::move(mean)),
        covariance_(Eigen::MatrixXd::Identity(n_, n_)),
        scaled_axes_(covariance_),
        inverse_root_(covariance_),
        path_(Eigen::VectorXd::Zero(n_)),
        width_path_(Eigen::VectorXd::Zero(n_)) {
    const auto n = static_cast<double>(n_);
    population_ = 4 + static_cast<std::size_t>(3.0 * std::log(n));
    parents_ = population_ / 2;
    for (std::size_t i = 0; i < parents_; ++i)
      weights_.push_back(std::log(0.5 * static_cast<double>(population_ + 1)) -
                         std::log(static_cast<double>(i + 1)));
    const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    double squares = 0.0;
    for (double& weight : weights_) {
      weight /= sum;
      squares += weight * weight;
    }
    effective_ = 1.0 / squares;
    c_path_ = (4.0 + effective_ / n) / (n + 4.0 + 2.0 * effective_ / n);
    c_width_ = (effective_ + 2.0) / (n + effective_ + 5.0);
    c_one_ = 2.0 / ((n + 1.3) * (n + 1.3) + effective_);
    c_rank_ = std::min(1.0 - c_one_, 2.0 * (effective_ - 2.0 + 1.0 / effective_) /
                                         ((n + 2.0) * (n + 2.0) + effective_));
    damping_ =
        1.0 + 2.0 * std::max(0.0, std::sqrt((effective_ - 1.0) / (n + 1.0)) - 1.0) + c_width_;
    expected_ = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
  }

  std::size_t population() const { return population_; }

  std::vector<Eigen::VectorXd> ask(std::size_t count, datasets::RandomStream& stream) const {
    std::vector<Eigen::VectorXd> points;
    for (std::size_t i = 0; i < count; ++i)
      points.emplace_back(mean_ + width_ * (scaled_axes_ * random_direction(n_, stream)));
    return points;
  }

  /// Moves the distribution towards the better half of a complete population.
  void tell(const std::vector<Eigen::VectorXd>& points, const std::vector<double>& scores) {
    ++generation_;
    const std::vector<std::size_t> order = ranked(scores);
    const Eigen::VectorXd before = mean_;
    mean_.setZero();
    for (std::size_t i = 0; i < parents_; ++i) mean_ += weights_[i] * points[order[i]];
    const Eigen::VectorXd moved = (mean_ - before) / width_;
    width_path_ = (1.0 - c_width_) * width_path_ +
                  std::sqrt(c_width_ * (2.0 - c_width_) * effective_) * (inverse_root_ * moved);
    const double length = width_path_.norm();
    const double forgotten =
        std::sqrt(1.0 - std::pow(1.0 - c_width_, 2.0 * static_cast<double>(generation_)));
    const bool steady =
        length / forgotten < (1.4 + 2.0 / (static_cast<double>(n_) + 1.0)) * expected_;
    path_ *= 1.0 - c_path_;
    if (steady) path_ += std::sqrt(c_path_ * (2.0 - c_path_) * effective_) * moved;
    const double kept = steady ? 0.0 : c_one_ * c_path_ * (2.0 - c_path_);
    covariance_ =
        (1.0 - c_one_ - c_rank_ + kept) * covariance_ + c_one_ * path_ * path_.transpose();
    for (std::size_t i = 0; i < parents_; ++i) {
      const Eigen::VectorXd step = (points[order[i]] - before) / width_;
      covariance_ += c_rank_ * weights_[i] * step * step.transpose();
    }
    width_ *= std::exp(c_width_ / damping_ * (length / expected_ - 1.0));
    width_ = std::min(width_, 1.0);
    decompose();
  }

 private:
  void decompose() {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance_);
    constexpr double kLeast = 1e-20;
    const Eigen::VectorXd roots = solver.eigenvalues().cwiseMax(kLeast).cwiseSqrt();
    scaled_axes_ = solver.eigenvectors() * roots.asDiagonal();
    inverse_root_ = solver.eigenvectors() * roots.cwiseInverse().asDiagonal() *
                    solver.eigenvectors().transpose();
  }

  Eigen::Index n_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_, scaled_axes_, inverse_root_;
  Eigen::VectorXd path_, width_path_;
  double width_ = kFirstWidth;
  std::size_t population_ = 0;
  std::size_t parents_ = 0;
  std::vector<double> weights_;
  double effective_ = 1.0;
  double c_path_ = 0.0, c_width_ = 0.0, c_one_ = 0.0, c_rank_ = 0.0;
  double damping_ = 1.0, expected_ = 1.0;
  int generation_ = 0;
};

class BoundedSearch {
 public:
  BoundedSearch(int evaluations, const ScorePoints& scores, const std::function<bool()>& stopped)
      : left_(evaluations), scores_(scores), stopped_(stopped) {}

  int left() const { return left_; }
  bool goes_on() const { return left_ > 0 && !stopped_(); }
  const Evolved& best() const { return best_; }

  /// Evaluates the points, after reflecting them into the box, and returns their scores.
  std::vector<double> evaluate(const std::vector<Eigen::VectorXd>& unbounded) {
    std::vector<Eigen::VectorXd> points;
    for (const Eigen::VectorXd& each : unbounded) points.push_back(reflected(each));
    std::vector<double> found = scores_(points);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!(found[i] > best_.score)) continue;
      best_.score = found[i];
      best_.point = points[i];
    }
    left_ -= static_cast<int>(points.size());
    best_.evaluations += static_cast<int>(points.size());
    return found;
  }

 private:
  int left_;
  const ScorePoints& scores_;
  const std::function<bool()>& stopped_;
  Evolved best_;
};

}  // namespace

Evolved maximise_in_box(Eigen::Index dimensions, int evaluations, datasets::RandomStream& stream,
                        const ScorePoints& scores, const std::function<bool()>& stopped) {
  BoundedSearch search(evaluations, scores, stopped);
  const int random = std::max(1, static_cast<int>(std::lround(kRandomShare * evaluations)));
  constexpr int kTogether = 16;
  for (int made = 0; made < random && search.goes_on(); made += kTogether) {
    std::vector<Eigen::VectorXd> points;
    for (int i = made; i < std::min(random, made + kTogether); ++i) {
      Eigen::VectorXd point(dimensions);
      for (double& each : point) each = datasets::uniform(stream, 0.0, 1.0);
      points.push_back(std::move(point));
    }
    search.evaluate(points);
  }
  Strategy strategy(search.best().point.size() > 0
                        ? search.best().point
                        : Eigen::VectorXd(Eigen::VectorXd::Constant(dimensions, 0.5)));
  while (search.goes_on()) {
    const auto count = std::min(strategy.population(), static_cast<std::size_t>(search.left()));
    const std::vector<Eigen::VectorXd> points = strategy.ask(count, stream);
    const std::vector<double> found = search.evaluate(points);
    if (count == strategy.population()) strategy.tell(points, found);
  }
  return search.best();
}

}  // namespace rigcal::calib
