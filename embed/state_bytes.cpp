#include "embed/state_bytes.hpp"

#include <string>

#include "base/diagnostic.hpp"
#include "embed/byte_stream.hpp"

namespace bough::embed {
namespace {

constexpr std::uint64_t kMagic = 0x31545347554f4221u;
constexpr std::uint64_t kMaxName = 256;

[[noreturn]] void fail(const std::string& what) {
  throw InputError("embed.bad-state", {}, what,
                   "restore a state that a simulation of the same model and options has saved");
}

void write_section(ByteWriter& w, const std::string& name, const Eigen::VectorXd& values) {
  w.write(std::uint64_t{name.size()});
  w.write(name.data(), name.size());
  w.write(static_cast<std::uint64_t>(values.size()));
  w.write(values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
}

std::pair<std::string, Eigen::VectorXd> read_section(ByteReader& r, std::size_t num_bytes) {
  std::string name(r.read_count(kMaxName), '\0');
  r.read(name.data(), name.size());
  Eigen::VectorXd values(static_cast<Eigen::Index>(r.read_count(num_bytes / sizeof(double))));
  r.read(values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
  return {name, values};
}

}  // namespace

std::uint64_t calc_hash(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
  return hash;
}

std::vector<std::byte> encode_state(const records::Checkpoint& state, std::uint64_t fingerprint) {
  ByteWriter w;
  w.write(kMagic);
  w.write(fingerprint);
  w.write(state.time);
  write_section(w, "state", state.state);
  w.write(std::uint64_t{state.memory.size()});
  for (const auto& [name, values] : state.memory) write_section(w, name, values);
  w.write(calc_hash(w.all));
  return std::move(w.all);
}

records::Checkpoint decode_state(std::span<const std::byte> bytes, std::uint64_t fingerprint, std::size_t size) {
  ByteReader r(bytes, [](const char* what) { fail(what); });
  if (r.read<std::uint64_t>() != kMagic) fail("these bytes are no state of a simulation");
  if (r.read<std::uint64_t>() != fingerprint) fail("the state is of another model or other options");
  records::Checkpoint state;
  state.time = r.read<double>();
  state.state = read_section(r, bytes.size()).second;
  for (auto left = r.read_count(kMaxName); left > 0; --left) state.memory.push_back(read_section(r, bytes.size()));
  const std::size_t end = r.at();
  if (r.read<std::uint64_t>() != calc_hash(bytes.first(end))) fail("the state is damaged");
  if (bytes.size() < size)
    fail("the state takes " + std::to_string(size) + " bytes, not " + std::to_string(bytes.size()));
  return state;
}

}  // namespace bough::embed
