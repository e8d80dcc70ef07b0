#include "embed/state_bytes.hpp"

#include <cstring>
#include <string>

#include "base/diagnostic.hpp"

namespace bough::embed {
namespace {

constexpr std::uint64_t kMagic = 0x31545347554f4221u;
constexpr std::uint64_t kMaxName = 256;

[[noreturn]] void fail(const std::string& what) {
  throw InputError("embed.bad-state", {}, what, "restore what a simulation of the same model and options has saved");
}

class Writer {
 public:
  void write(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  void write(std::uint64_t value) { write(&value, sizeof value); }
  void write(double value) { write(&value, sizeof value); }
  void write(const std::string& name, const Eigen::VectorXd& values) {
    write(std::uint64_t{name.size()});
    write(name.data(), name.size());
    write(static_cast<std::uint64_t>(values.size()));
    write(values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
  }
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  void read(void* to, std::size_t size) {
    if (size > bytes_.size() - at_) fail("the state ends early");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  std::uint64_t read_count(std::uint64_t limit) {
    std::uint64_t value = 0;
    read(&value, sizeof value);
    if (value > limit) fail("the state is damaged");
    return value;
  }
  std::pair<std::string, Eigen::VectorXd> read_section() {
    std::string name(read_count(kMaxName), '\0');
    read(name.data(), name.size());
    Eigen::VectorXd values(static_cast<Eigen::Index>(read_count(bytes_.size() / sizeof(double))));
    read(values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
    return {name, values};
  }
  std::size_t at() const { return at_; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace

std::uint64_t calc_hash(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
  return hash;
}

std::vector<std::byte> encode_state(const records::Checkpoint& state, std::uint64_t fingerprint) {
  Writer w;
  w.write(kMagic);
  w.write(fingerprint);
  w.write(state.time);
  w.write("state", state.state);
  w.write(std::uint64_t{state.memory.size()});
  for (const auto& [name, values] : state.memory) w.write(name, values);
  w.write(calc_hash(w.bytes_));
  return std::move(w.bytes_);
}

records::Checkpoint decode_state(std::span<const std::byte> bytes, std::uint64_t fingerprint, std::size_t size) {
  Reader r(bytes);
  std::uint64_t magic = 0, found = 0, sum = 0;
  r.read(&magic, sizeof magic);
  if (magic != kMagic) fail("these bytes are no state of a simulation");
  r.read(&found, sizeof found);
  if (found != fingerprint) fail("the state is of another model or other options");
  records::Checkpoint state;
  r.read(&state.time, sizeof state.time);
  state.state = r.read_section().second;
  for (auto left = r.read_count(kMaxName); left > 0; --left) state.memory.push_back(r.read_section());
  const std::size_t end = r.at();
  r.read(&sum, sizeof sum);
  if (sum != calc_hash(bytes.first(end))) fail("the state is damaged");
  if (bytes.size() < size)
    fail("the state takes " + std::to_string(size) + " bytes, not " + std::to_string(bytes.size()));
  return state;
}

}  // namespace bough::embed
