#include "calib/search/multiple_shooting.hpp"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>

#include "calib/descent/ceres_watch.hpp"
#include "calib/problem/initial_state.hpp"
#include "calib/problem/r_factor.hpp"
#include "calib/search/prior_cost.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

/// For each stage, the jump (in floors, the absolute tolerances of the states) that has the same
/// weight as a residual of one standard deviation. It decreases from about a tenth of the usual
/// size of the states to less than a simulation can resolve.
constexpr double kJumps[] = {3e3, 30.0, 0.3, 3e-3};
constexpr std::size_t kStages = std::size(kJumps);
/// Relative change in cost at which each stage ends.
constexpr double kStageChange[] = {1e-3, 1e-3, 1e-6, 1e-10};
/// Number of floors per unit of a state's coordinate. The coordinates are then of order 1, like the
/// other unknowns.
constexpr double kCoordinate = 1e4;
constexpr std::size_t kLeastSamples = 4;
/// The state at a node is read from the record over this fraction of an interval on each side.
constexpr double kReadShare = 0.1;
/// Levenberg-Marquardt damping is relative to the weights. Larger weights on the jumps would
/// therefore damp a common motion of all states more, unless the radius grew with the square of the
/// weights.
constexpr double kTrustRadii[] = {1e2, 1e4, 1e8, 1e12};
/// Reduced systems up to this size are solved densely, so that the result does not depend, bit for
/// bit, on which sparse library is available.
constexpr std::size_t kMostDense = 1000;

/// An interval of a condition's record that is simulated separately. Its last sample is also the
/// first sample of the next piece, where it is counted.
struct Piece {
  std::size_t condition = 0;
  std::size_t first = 0;                   ///< index of the first sample
  std::size_t last = 0;                    ///< index of the last sample
  std::size_t begin_row = 0, end_row = 0;  ///< range in the condition's `rows`
  int node = -1;  ///< node that contains its initial state; -1: the condition's own initial state
  int next_node = -1;  ///< node that contains the state at its end; -1: none
};

/// The state between two pieces.
struct Node {
  std::size_t number = 0;  ///< number of the node within its record
  std::size_t first = 0;   ///< index of the node's first coordinate
  Eigen::VectorXd floor;

  int states() const { return static_cast<int>(floor.size()); }
};

struct PieceEvaluation {
  model::SimulationStatus status = model::SimulationStatus::ok;
  double failed_at_s = 0.0;
  std::string reason;
  /// R factor of [J r]. The columns are the acting unknowns, the coordinates of the node if there
  /// is one, and r.
  Eigen::MatrixXd r_factor;
  Eigen::VectorXd end;           ///< final state, in floors
  Eigen::MatrixXd end_jacobian;  ///< same columns as the R factor except the last
};

/// Returns the first sample of each piece of a condition.
std::vector<std::size_t> cuts(const ProblemCondition& condition, double interval_s) {
  const auto times = condition.fit_times();
  const double span_s = times.back() - times.front();
  const double wanted = std::max(1.0, std::round(span_s / interval_s));
  const auto refuse = [&] {
    throw InputError(condition.condition->where,
                     fmt::format("condition \"{}\": [fit] shooting_interval = \"{:g} s\" has "
                                 "fewer than {} samples of its record",
                                 condition.condition->id, interval_s, kLeastSamples));
  };
  // This is checked before anything of this length is allocated.
  if (wanted > 1.0 && wanted * kLeastSamples > static_cast<double>(times.size() - 1)) refuse();
  const auto pieces = static_cast<std::size_t>(wanted);
  std::vector<std::size_t> result{0};
  for (std::size_t k = 1; k < pieces; ++k) {
    const double at_s =
        times.front() + span_s * static_cast<double>(k) / static_cast<double>(pieces);
    const auto found = std::lower_bound(times.begin(), times.end(), at_s);
    result.push_back(static_cast<std::size_t>(found - times.begin()));
  }
  result.push_back(times.size() - 1);
  for (std::size_t k = 1; pieces > 1 && k < result.size(); ++k) {
    if (result[k] < result[k - 1] + kLeastSamples) refuse();
  }
  return result;
}

/// All pieces and the states between them. Evaluates the pieces in parallel.
class Pieces final : public ceres::EvaluationCallback {
 public:
  Pieces(const Problem& problem, Evaluator& evaluator, double interval_s)
      : problem_(problem), evaluator_(evaluator) {
    for (std::size_t i = 0; i < problem.conditions.size(); ++i) cut(i, interval_s);
    evaluations_.resize(pieces_.size());
  }

  const std::vector<Piece>& pieces() const { return pieces_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(int number) const { return nodes_[static_cast<std::size_t>(number)]; }
  std::span<const double> z() const {
    return std::span(coordinates_).first(problem_.map.unknowns().size());
  }
  /// Coordinates for Ceres: the unknowns in the unit box, followed by state / (kCoordinate floor)
  /// for every node. They are contiguous in memory, because Ceres orders its blocks by address.
  double* unknown(std::size_t j) { return &coordinates_[j]; }
  double* coordinates(const Node& node) { return &coordinates_[node.first]; }
  const PieceEvaluation& evaluation(std::size_t piece) const { return evaluations_[piece]; }

  /// Sets the unknowns to z, and every node to the state determined from the record.
  ///
  /// @return  false if the state at a node cannot be determined
  bool begin_at(std::span<const double> z, double interval_s) {
    coordinates_.assign(z.begin(), z.end());
    for (const Piece& piece : pieces_) {
      if (piece.node < 0) continue;
      const ProblemCondition& condition = problem_.conditions[piece.condition];
      const auto times = condition.fit_times();
      const double at_s = times[piece.first];
      const double half_width_s =
          std::max(kReadShare * interval_s, 2.0 * (times[piece.first] - times[piece.first - 1]));
      model::ParameterValues values = problem_.values_at(piece.condition, z);
      for (const auto& [index, value] :
           recorded_state(*problem_.campaign, *condition.record, values, at_s, half_width_s))
        values.set(index, value);
      model::Rig rig = condition.rig;
      rig.initial = model::InitialState::given;
      rig.before = model::Before::hold;  // the drive began long before this sample
      const auto found = model::simulate(rig, values, {}, condition.inputs, {&at_s, 1}, {});
      if (!found.ok()) return false;
      Node& node = nodes_[static_cast<std::size_t>(piece.node)];
      node.floor = found.state_floor;
      node.first = coordinates_.size();
      const Eigen::VectorXd y = found.end_state.array() / (kCoordinate * node.floor.array());
      coordinates_.insert(coordinates_.end(), y.begin(), y.end());
    }
    return true;
  }

  void set_tolerance(double tolerance) { tolerance_ = tolerance; }

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool /*new_evaluation_point*/) override {
    if (coordinates_ == evaluated_at_ && tolerance_ == evaluated_with_) return;
    evaluated_at_ = coordinates_;
    evaluated_with_ = tolerance_;
    try {
      if (!aborted()) return evaluate();
    } catch (...) {
      error_ = std::current_exception();
    }
    for (PieceEvaluation& each : evaluations_) each.status = model::SimulationStatus::cancelled;
  }

  /// Returns true if every piece could be simulated.
  bool ok() const {
    return std::all_of(evaluations_.begin(), evaluations_.end(), [](const PieceEvaluation& each) {
      return each.status == model::SimulationStatus::ok;
    });
  }
  bool aborted() const { return error_ != nullptr || evaluator_.budget().spent(); }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

  /// Returns the largest jump between two pieces, in floors.
  double largest_gap() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].next_node < 0) continue;
      if (evaluations_[i].end.size() == 0) return std::numeric_limits<double>::infinity();
      const Node& next = node(pieces_[i].next_node);
      const Eigen::VectorXd gap =
          evaluations_[i].end - (state(next).array() / next.floor.array()).matrix();
      largest = std::max(largest, gap.cwiseAbs().maxCoeff());
    }
    return largest;
  }

 private:
  Eigen::VectorXd state(const Node& node) const {
    const Eigen::Map<const Eigen::VectorXd> y(&coordinates_[node.first], node.floor.size());
    return kCoordinate * (y.array() * node.floor.array()).matrix();
  }

  void cut(std::size_t i, double interval_s) {
    const ProblemCondition& condition = problem_.conditions[i];
    const std::vector<std::size_t> at = cuts(condition, interval_s);
    if (at.size() > 2 && condition.values.is_given("sample_time")) {
      throw InputError(condition.condition->where,
                       fmt::format("condition \"{}\": [fit] shooting_interval goes with continuous "
                                   "controllers alone: expected none with sample_time",
                                   condition.condition->id));
    }
    const auto row_of = [&](std::size_t sample) {
      const auto found = std::lower_bound(condition.rows.begin(), condition.rows.end(), sample);
      return static_cast<std::size_t>(found - condition.rows.begin());
    };
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      Piece piece{i, at[k], at[k + 1], row_of(at[k]), row_of(at[k + 1]), -1, -1};
      if (k > 0) piece.node = static_cast<int>(nodes_.size()) - 1;
      if (k + 2 < at.size()) {
        piece.next_node = static_cast<int>(nodes_.size());
        nodes_.push_back({k, 0, {}});
      } else {
        piece.end_row = condition.rows.size();
      }
      pieces_.push_back(piece);
    }
  }

  void evaluate() {
    parallel_for(pieces_.size(), evaluator_.threads(),
                 [this](std::size_t i) { evaluations_[i] = evaluate_piece(pieces_[i]); });
    Evaluation told;  // used only to update the counters
    told.z.assign(z().begin(), z().end());
    told.conditions.resize(problem_.conditions.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      ConditionEvaluation& each = told.conditions[pieces_[i].condition];
      if (!each.ok()) continue;
      each.status = evaluations_[i].status;
      each.failed_at_s = evaluations_[i].failed_at_s;
      each.reason = evaluations_[i].reason;
    }
    evaluator_.record(told);
  }

  PieceEvaluation evaluate_piece(const Piece& piece) const {
    const ProblemCondition& condition = problem_.conditions[piece.condition];
    const auto options =
        simulation_options(problem_, piece.condition, tolerance_, evaluator_.budget().cancel());
    const auto values = problem_.values_at(piece.condition, z());
    const auto times = condition.fit_times().subspan(piece.first, piece.last - piece.first + 1);
    const Node* from = piece.node < 0 ? nullptr : &node(piece.node);
    const model::Simulation run =
        from == nullptr ? model::simulate(condition.rig, values, condition.free, condition.inputs,
                                          times, condition.outputs, options)
                        : model::simulate_from(state(*from), condition.rig, values, condition.free,
                                               condition.inputs, times, condition.outputs, options);
    PieceEvaluation result;
    result.status = run.status;
    result.failed_at_s = run.failed_at_s;
    result.reason = run.reason;
    if (!run.ok()) return result;

    const Eigen::VectorXd by_z = acting_slopes(problem_, piece.condition, z());
    const Eigen::Index states = from == nullptr ? 0 : from->states();
    Eigen::VectorXd slopes(by_z.size() + states);
    slopes.head(by_z.size()) = by_z;
    if (from != nullptr) slopes.tail(states) = kCoordinate * from->floor;
    RFactor r_factor(slopes.size() + 1);
    double square_sum = 0.0;
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      r_factor.add(weighted_rows(condition, k, {piece.begin_row, piece.end_row, piece.first}, run,
                                 slopes, problem_.campaign->fit, square_sum));
    }
    result.r_factor = r_factor.get();
    const Eigen::VectorXd per_floor = run.state_floor.cwiseInverse();
    result.end = run.end_state.cwiseProduct(per_floor);
    result.end_jacobian = per_floor.asDiagonal() * run.end_sensitivities * slopes.asDiagonal();
    if (!result.r_factor.allFinite() || !result.end_jacobian.allFinite()) {
      result.status = model::SimulationStatus::not_finite;
      result.failed_at_s = times.back();
      result.reason = "a residual or its derivative is not finite";
    }
    return result;
  }

  const Problem& problem_;
  Evaluator& evaluator_;
  std::vector<Piece> pieces_;
  std::vector<Node> nodes_;
  std::vector<PieceEvaluation> evaluations_;
  std::vector<double> coordinates_;
  double tolerance_ = 0.0;
  std::vector<double> evaluated_at_;
  double evaluated_with_ = 0.0;
  std::exception_ptr error_;
};

/// Copies the columns of a matrix to Ceres, one parameter block after the other.
void give_jacobians(const Eigen::MatrixXd& columns, const std::vector<int>& sizes,
                    double** jacobians) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Index first = 0;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    if (jacobians[b] != nullptr)
      Eigen::Map<RowMajor>(jacobians[b], columns.rows(), sizes[b]) =
          columns.middleCols(first, sizes[b]);
    first += sizes[b];
  }
}

/// Residuals of the samples in a piece. Its parameter blocks are the acting unknowns, then the node
/// if there is one.
class PieceCost final : public ceres::CostFunction {
 public:
  PieceCost(const Pieces& pieces, std::size_t piece, const std::vector<int>& sizes)
      : pieces_(pieces), piece_(piece) {
    int columns = 0;
    for (const int size : sizes) columns += size;
    set_num_residuals(columns + 1);
    *mutable_parameter_block_sizes() = sizes;
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    const PieceEvaluation& found = pieces_.evaluation(piece_);
    if (found.status != model::SimulationStatus::ok) return false;
    const Eigen::Index columns = found.r_factor.cols() - 1;
    Eigen::Map<Eigen::VectorXd>(residuals, columns + 1) = found.r_factor.col(columns);
    if (jacobians != nullptr)
      give_jacobians(found.r_factor.leftCols(columns), parameter_block_sizes(), jacobians);
    return true;
  }

 private:
  const Pieces& pieces_;
  std::size_t piece_;
};

/// The jump from the end of a piece to the next node, divided by the jump that the stage allows.
/// Its parameter blocks are those of PieceCost, then the next node.
class JumpCost final : public ceres::CostFunction {
 public:
  JumpCost(const Pieces& pieces, std::size_t piece, const std::vector<int>& sizes, double jump)
      : pieces_(pieces), piece_(piece), weight_(1.0 / jump) {
    set_num_residuals(sizes.back());
    *mutable_parameter_block_sizes() = sizes;
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const PieceEvaluation& found = pieces_.evaluation(piece_);
    if (found.status != model::SimulationStatus::ok) return false;
    const Eigen::Index states = num_residuals();
    const std::size_t next = parameter_block_sizes().size() - 1;
    const Eigen::Map<const Eigen::VectorXd> to(parameters[next], states);
    Eigen::Map<Eigen::VectorXd>(residuals, states) = weight_ * (found.end - kCoordinate * to);
    if (jacobians == nullptr) return true;
    const Eigen::Index before = found.end_jacobian.cols();
    Eigen::MatrixXd columns(states, before + states);
    if (before > 0) columns.leftCols(before) = weight_ * found.end_jacobian;
    columns.rightCols(states) = -weight_ * kCoordinate * Eigen::MatrixXd::Identity(states, states);
    give_jacobians(columns, parameter_block_sizes(), jacobians);
    return true;
  }

 private:
  const Pieces& pieces_;
  std::size_t piece_;
  double weight_;
};

/// Runs one stage, which starts from the unknowns and nodes in `pieces` and updates them.
///
/// @return  false if not even the start of the stage could be simulated
bool stage(const Problem& problem, Pieces& pieces, std::size_t number, int iterations,
           CeresWatch& watch) {
  pieces.PrepareForEvaluation(true, true);
  if (!pieces.ok()) return false;
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &pieces;
  ceres::Problem system(problem_options);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::size_t reduced = problem.map.unknowns().size();
  for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j) {
    double* z = pieces.unknown(j);
    system.AddParameterBlock(z, 1);
    system.SetParameterLowerBound(z, 0, 0.0);
    system.SetParameterUpperBound(z, 0, 1.0);
    ordering->AddElementToGroup(z, 1);
    if (const auto& prior = problem.map.unknowns()[j].prior)
      system.AddResidualBlock(new PriorCost(problem.map, static_cast<int>(j), *prior), nullptr, z);
  }
  for (const Node& node : pieces.nodes()) {
    system.AddParameterBlock(pieces.coordinates(node), node.states());
    const bool eliminated = node.number % 2 == 0;  // no residual depends on two of these
    ordering->AddElementToGroup(pieces.coordinates(node), eliminated ? 0 : 1);
    if (!eliminated) reduced += static_cast<std::size_t>(node.states());
  }
  for (std::size_t i = 0; i < pieces.pieces().size(); ++i) {
    const Piece& piece = pieces.pieces()[i];
    std::vector<double*> blocks;
    std::vector<int> sizes;
    const auto add_node = [&](int node) {
      blocks.push_back(pieces.coordinates(pieces.node(node)));
      sizes.push_back(pieces.node(node).states());
    };
    for (const int j : problem.map.acting(piece.condition)) {
      blocks.push_back(pieces.unknown(static_cast<std::size_t>(j)));
      sizes.push_back(1);
    }
    if (piece.node >= 0) add_node(piece.node);
    if (!blocks.empty() && piece.end_row > piece.begin_row)
      system.AddResidualBlock(new PieceCost(pieces, i, sizes), nullptr, blocks);
    if (piece.next_node < 0) continue;
    add_node(piece.next_node);
    system.AddResidualBlock(new JumpCost(pieces, i, sizes, kJumps[number]), nullptr, blocks);
  }

  ceres::Solver::Options settings = quiet_settings();
  settings.linear_solver_type = reduced <= kMostDense ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
  settings.linear_solver_ordering = ordering;
  settings.max_num_iterations = iterations;
  settings.initial_trust_region_radius = kTrustRadii[number];
  settings.function_tolerance = kStageChange[number];
  settings.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &system, &summary);
  return summary.IsSolutionUsable();
}

}  // namespace

ShootingResult multiple_shooting(const Problem& problem, Evaluator& evaluator,
                                 std::vector<double> z, double interval_s, int most,
                                 Iterations& iterations) {
  ShootingResult result{std::move(z), 0, 0.0};
  Pieces pieces(problem, evaluator, interval_s);
  if (pieces.nodes().empty()) return result;  // the whole record is a single piece
  result.largest_gap = std::numeric_limits<double>::infinity();
  if (!pieces.begin_at(result.z, interval_s)) return result;
  const int end = iterations.used() + most;
  const std::function<bool(const DescentStep&)> enough = [&](const DescentStep& step) {
    iterations.tell(step.number, step.cost, step.relative_change, step.seconds);
    return pieces.aborted();
  };
  for (std::size_t k = 0; k < kStages; ++k) {
    const int left = (end - iterations.used()) / static_cast<int>(kStages - k);
    pieces.set_tolerance(k + 1 < kStages ? problem.coarse_tolerance() : problem.tolerance);
    std::exception_ptr error;
    CeresWatch watch(enough, error);
    const bool usable = stage(problem, pieces, k, left, watch);
    pieces.rethrow();
    if (error) std::rethrow_exception(error);
    iterations.add(watch.made());
    result.iterations += watch.made();
    if (!usable || pieces.aborted()) break;
    result.z.assign(pieces.z().begin(), pieces.z().end());
    pieces.PrepareForEvaluation(true, true);  // the last trial point may not be the end point
    result.largest_gap = pieces.largest_gap();
  }
  return result;
}

}  // namespace rigcal::calib
