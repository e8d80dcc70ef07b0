#include "cli/static/static_output.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <utility>

#include "analysis/static/case_extremes.hpp"
#include "cli/common/options.hpp"
#include "cli/static/extremes_tables.hpp"
#include "cli/static/static_tables.hpp"
#include "fe/linear/threads.hpp"

namespace bough::cli {
namespace {

/// Numbers on the g-set, of all subcases: fewer are done before a thread has started.
constexpr Eigen::Index kNumbersOfThread = 100000;

bool is_worth_threads(const std::vector<records::StaticSubcase>& subcases) {
  const auto count = static_cast<Eigen::Index>(subcases.size());
  return count > 0 && count * subcases.front().displacement.size() > kNumbersOfThread && linear::get_num_threads() > 1;
}

}  // namespace

StaticOutput::~StaticOutput() {
  if (running_.valid()) running_.wait();
}

void StaticOutput::set_model(const fe::Model& model) {
  wait();
  result_.dof_map = model.calc_dof_map();
  result_.mesh = model.calc_mesh();
  turns_.clear();
  for (const auto& node : model.nodes())
    for (int part = 0; part < node.num_dofs / 3; ++part)
      turns_.emplace_back(node.first_gdof + 3 * part, node.R_basic_cd.transpose());
}

void StaticOutput::wait() {
  if (running_.valid()) running_.get();
}

bool StaticOutput::has_failed() {
  if (running_.valid() && running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  wait();
  return failure_ != nullptr;
}

const records::StaticResult& StaticOutput::get_result() {
  wait();
  return result_;
}

void StaticOutput::add(std::vector<records::StaticSubcase> subcases) {
  wait();
  if (!is_worth_threads(subcases)) {
    write(subcases);
    show(subcases);
    if (options_.keeps) std::move(subcases.begin(), subcases.end(), std::back_inserter(result_.subcases));
    return;
  }
  running_ = std::async(
      std::launch::async,
      [this](std::vector<records::StaticSubcase> own) {
        linear::do_both([&] { write(own); }, [&] { show(own); });
        if (options_.keeps) std::move(own.begin(), own.end(), std::back_inserter(result_.subcases));
      },
      std::move(subcases));
}

void StaticOutput::write(const std::vector<records::StaticSubcase>& subcases) {
  if (failure_) return;
  try {
    if (!options_.path.empty()) {
      if (!file_) file_.emplace(options_.path);
      for (const auto& subcase : subcases) file_->add(subcase);
      file_->start_sync();
    }
    if (options_.has_extremes)
      for (const auto& subcase : subcases) analysis::add_to_extremes(result_.dof_map, subcase, result_.extremes);
  } catch (const Failure&) {
    failure_ = std::current_exception();
  }
}

void StaticOutput::show(const std::vector<records::StaticSubcase>& subcases) {
  const auto show_one = [&](const records::StaticSubcase& subcase) {
    if (options_.has_json)
      json_.push_back(to_json(result_.dof_map, subcase, options_.is_full));
    else if (options_.has_text)
      text_ += format_static(result_.dof_map, subcase, options_.is_full);
  };
  for (const auto& subcase : subcases) {
    if (!options_.in_cd) {
      show_one(subcase);
      continue;
    }
    const auto turned = turn_to_cd(subcase);
    show_one(turned);
    if (options_.has_extremes) analysis::add_to_extremes(result_.dof_map, turned, shown_extremes_);
  }
}

records::StaticSubcase StaticOutput::turn_to_cd(records::StaticSubcase s) const {
  for (Eigen::VectorXd* v : {&s.displacement, &s.load, &s.reaction, &s.mpc_force, &s.inertia})
    for (const auto& [row, R] : turns_) {
      if (v->size() == 0) break;
      auto part = v->segment<3>(row);
      part = (R * part).eval();
    }
  return s;
}

void StaticOutput::finish(const std::vector<std::pair<std::string, std::string>>& source) {
  wait();
  if (failure_) std::rethrow_exception(failure_);
  result_.source = source;
  if (file_) file_->commit(result_);
  file_.reset();
  if (options_.has_extremes) text_ += format_case_extremes(options_.in_cd ? shown_extremes_ : result_.extremes);
}

nlohmann::json StaticOutput::get_extremes() const {
  return to_json(options_.in_cd ? shown_extremes_ : result_.extremes);
}

}  // namespace bough::cli
