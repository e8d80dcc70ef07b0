#include "formats/flx/fragment.hpp"

#include <fmt/format.h>

#include "base/diagnostic.hpp"

namespace bough::flx {

namespace {

constexpr const char* kHead =
    R"(! What problem.INT of TREETOPS needs for geometric stiffening (NASA-CR-202063 4.1.3, 4.1.4), by bough flx --int.
! A list to type into TREESET: the report names what is to be added, not the columns of .INT.
! One item a line: its kind, its number, words with their values; ! starts a remark. Units are those of the model.
)";

constexpr const char* kLoads[] = {"ax",    "ay",    "az",    "alx",   "aly",   "alz",
                                  "wx*wx", "wy*wy", "wz*wz", "wx*wy", "wx*wz", "wy*wz"};
constexpr const char* kAxes[] = {"1 0 0", "0 1 0", "0 0 1"};

struct Counters {
  int jet = 0, sensor = 0, controller = 0;
};

class FragmentWriter {
 public:
  FragmentWriter(const FlxFile& file, Counters& next, std::string& text) : file_(file), next_(next), text_(text) {}

  void write() {
    if (static_cast<int>(file_.special_id.size()) != file_.num_modes() + 1)
      throw InputError("flx.no-special-nodes", {},
                       fmt::format("body \"{}\" has {} special nodes, expected {}: one more than its modes", file_.name,
                                   file_.special_id.size(), file_.num_modes() + 1),
                       "write its .FLX with --special-nodes");
    put("\nBODY {} MODES {} MODOPT {} MASS {:.9g}  ! {}\n", file_.body_id, file_.num_modes(), file_.modopt, file_.mass,
        file_.name);
    if (file_.modopt != 0)
      put("! Stiffening wants the integrals of every order (4.1.4.1): write the .FLX with --modopt 0.\n");
    write_rigid();
    write_nodes();
    write_jets();
    write_sensors();
    write_controller();
  }

 private:
  template <class... Values>
  void put(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...);
  }

  void write_rigid() {
    if (!file_.has_rigid) {
      put("! The .FLX does not say the mass centre and the inertia.\n");
      return;
    }
    const auto& c = file_.more.cg;
    const auto& J = file_.more.inertia;
    put("CG {:.9g} {:.9g} {:.9g}\n", c[0], c[1], c[2]);
    put("INERTIA XX {:.9g} YY {:.9g} ZZ {:.9g} XY {:.9g} XZ {:.9g} YZ {:.9g}  ! tensor about the origin of the body "
        "frame: XY = -integral of x y dm\n",
        J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2));
  }

  void write_nodes() {
    for (std::size_t i = 0; i < file_.node_id.size(); ++i) {
      const auto p = file_.node_xyz.row(static_cast<Eigen::Index>(i));
      put("NODE {} AT {:.9g} {:.9g} {:.9g}\n", file_.node_id[i], p[0], p[1], p[2]);
    }
    // F_I and A_I are about the origin: there the sensors are, and forces there turn nothing.
    for (std::size_t s = 0; s < file_.special_id.size(); ++s)
      put("NODE {} AT 0 0 0  ! special: {}\n", file_.special_id[s],
          s == 0 ? "no gains" : fmt::format("unit x in mode {}", s));
  }

  void write_jets() {
    first_jet_ = next_.jet;
    for (std::size_t s = 0; s < file_.special_id.size(); ++s)
      put("ACTUATOR {} JET BODY {} NODE {} AXIS 1 0 0  ! {}\n", next_.jet++, file_.body_id, file_.special_id[s],
          s == 0 ? "takes the sum of the others off the rigid body" : fmt::format("modal force of mode {}", s));
  }

  void write_sensors() {
    first_sensor_ = next_.sensor;
    const int node = file_.special_id.front();
    constexpr const char* kKinds[] = {"ACCELEROMETER", "GYRO", "ANGULAR-ACCELEROMETER"};
    constexpr const char* kSigns[] = {"a", "w", "al"};
    for (const int kind : {0, 2, 1})
      for (int axis = 0; axis < 3; ++axis)
        put("SENSOR {} {} BODY {} NODE {} AXIS {}  ! {}{}\n", next_.sensor++, kKinds[kind], file_.body_id, node,
            kAxes[axis], kSigns[kind], "xyz"[axis]);
  }

  void write_controller() {
    const int n = file_.num_modes();
    put("CONTROLLER {} USER INPUTS {} OUTPUTS {}\n", next_.controller, 9, n + 1);
    for (int i = 0; i < 9; ++i)
      put("CONNECT SENSOR {} TO CONTROLLER {} INPUT {}\n", first_sensor_ + i, next_.controller, i + 1);
    for (int s = 0; s <= n; ++s)
      put("CONNECT CONTROLLER {} OUTPUT {} TO ACTUATOR {}\n", next_.controller, s + 1, first_jet_ + s);
    put("! Inputs 1-3 a, 4-6 al, 7-9 w, in body axes. A_I:");
    for (int l = 0; l < records::kNumInertialLoads; ++l) {
      const bool is_zero = file_.has_stiffening && (!file_.more.kg_inertial_computed[static_cast<std::size_t>(l)] ||
                                                    file_.more.kg_inertial[static_cast<std::size_t>(l)].isZero(0));
      put("{} A{} = {}{}", l > 0 ? "," : "", l + 1, kLoads[l], is_zero ? " (not needed)" : "");
    }
    put(".\n! Output 1 + j: f_j = - sum over l, k of A_l K_G1(l)(j,k) eta_k - sum over e, k of f_e K_G2(e)(j,k) "
        "eta_k;\n"
        "! output 1: - (f_1 + ... + f_{}). eta: the modal coordinates of the body; f_e: forces between bodies from "
        "the\n"
        "! array FCONI, which is in the inertial frame (4.1.4.2), turned into body axes, and the user's own loads.\n",
        n);
    if (file_.has_stiffening)
      put("! K_G1 and K_G2 stand in the .FLX, in its lines !+ KG1 and !+ KG2.\n");
    else
      put("! K_G1 and K_G2: bough flx --stiffening writes them into the .FLX.\n");
    ++next_.controller;
  }

  const FlxFile& file_;
  Counters& next_;
  std::string& text_;
  int first_jet_ = 0, first_sensor_ = 0;
};

}  // namespace

std::string make_fragment(const std::vector<FlxFile>& bodies, int first_id) {
  std::string text = kHead;
  Counters next{first_id, first_id, first_id};
  for (const auto& body : bodies) FragmentWriter(body, next, text).write();
  return text;
}

}  // namespace bough::flx
