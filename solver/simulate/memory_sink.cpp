#include "solver/simulate/memory_sink.hpp"

#include "base/diagnostic.hpp"

namespace bough::solver {

void MemorySink::begin(const records::ResultsHeader& header) {
  *this = MemorySink();
  header_ = header;
}

void MemorySink::write_sample(const Eigen::Ref<const Eigen::VectorXd>& sample) { samples_.emplace_back(sample); }

void MemorySink::end(bool completed, const std::string& reason) {
  ended_ = true;
  completed_ = completed;
  reason_ = reason;
}

bool MemorySink::has(const std::string& path) const {
  for (const auto& channel : header_.channels) {
    if (channel.path == path) return true;
  }
  return false;
}

Eigen::MatrixXd MemorySink::get(const std::string& path) const {
  BOUGH_DEMAND(has(path));
  int first = 0;
  for (const auto& channel : header_.channels) {
    if (channel.path != path) {
      first += channel.size;
      continue;
    }
    Eigen::MatrixXd values(num_samples(), channel.size);
    for (int i = 0; i < num_samples(); ++i)
      values.row(i) = samples_[static_cast<size_t>(i)].segment(first, channel.size);
    return values;
  }
  return {};
}

}  // namespace bough::solver
