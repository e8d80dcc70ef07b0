#include "cli/common/command_help.hpp"

#include <map>

#include "base/diagnostic.hpp"

namespace bough::cli {

const CommandHelp& get_command_help(const std::string& command) {
  static const std::map<std::string, CommandHelp> helps{
      {"check",
       {"Read a deck, body, system or HDF5 file; print its content and every error",
        "Example:\n  bough check boom.bdf\n  bough check spinup.toml --json"}},
      {"modes",
       {"Normal modes (SOL 103), complex modes (SOL 107, 110) or buckling load factors (SOL 105) of a deck",
        "Example:\n  bough modes boom.bdf --number 6 -o boom-modes.h5 --vtu boom.vtu\n"
        "  bough modes column.bdf --buckling\n  bough modes boom.bdf --ese --compare boom.h5\n"
        "  mpirun -n 2 bough modes boom.bdf"}},
      {"static",
       {"Static solution (SOL 101, 106) of every subcase with a load",
        "Example:\n  bough static frame.bdf -o frame-static.h5\n  bough static frame.bdf --subcase 2 --full"}},
      {"frequency",
       {"Frequency response of a deck, by modes with residual vectors (SOL 111) or directly (SOL 108)",
        "Example:\n  bough frequency bracket.bdf -o bracket.h5 --csv bracket.csv\n"
        "  bough frequency bracket.bdf --grid 12 --max-hz 500 --punch bracket.pch"}},
      {"transient",
       {"Transient response of a deck, by modes with residual vectors (SOL 112) or directly (SOL 109)",
        "Example:\n  bough transient bracket.bdf -o bracket.h5 --csv bracket.csv\n"
        "  bough transient bracket.bdf --grid 12 --json --full"}},
      {"matrices",
       {"Stiffness, mass, damping and geometric stiffness of a deck before constraints",
        "Example:\n  bough matrices column.bdf -o column.h5\n  bough matrices column.bdf --to mtx -o column.mtx"}},
      {"split",
       {"Cuts a deck into several bodies with a system file that joins them",
        "Example:\n  bough split mast.bdf --parts 8\n  bough split mast.bdf --plane x=2.5 --plane x=5\n"
        "  bough split wing.bdf --elements property:3 --elements 1-200 -o wing-parts\n"
        "  bough split frame.bdf --grids 11,21"}},
      {"reduce",
       {"A deck becomes a flexible body: modes, mass integrals, geometric stiffness",
        "Example:\n  bough reduce boom.toml\n  bough reduce boom.bdf --modes 3 --interface 41 -o boom.h5\n"
        "  bough reduce boom.bdf --modes 3 --interface 41 --recover 1,20-25 -o boom.h5\n"
        "  bough reduce boom.bdf --matrices boom.op4 --modes 3\n  mpirun -n 2 bough reduce boom.toml"}},
      {"integrals",
       {"Mass integrals of given matrices and modes (NASA-CR-202063 4.2.3)",
        "Example:\n  bough integrals test.inp test.mat -o test.FLX\n"
        "  bough integrals test.inp test.mat --fi test.fi --digits 17 -o test.FLX"}},
      {"flx",
       {"Flexible bodies become a .FLX file for TREETOPS, or such a file is read",
        "Example:\n  bough flx boom.h5 --special-nodes -o boom.FLX\n  bough flx boom.h5 --layout site.layout -o "
        "boom.FLX\n"
        "  bough flx left.h5 right.h5 --stiffening -o panels.FLX\n"
        "  bough flx boom.h5 --special-nodes --int boom.int.txt -o boom.FLX\n"
        "  bough flx --read boom.FLX --json"}},
      {"compare",
       {"Two bodies or modes files side by side; modes against a test; the integrals of one body",
        "Example:\n  bough compare boom.h5\n  bough compare boom.h5 boom-modes.h5 --mass boom-matrices.h5\n"
        "  bough compare --refinement boom10.h5 boom20.h5 boom40.h5\n"
        "  bough compare boom-modes.h5 --test survey.unv --tam guyan --deck boom.bdf\n"
        "  bough compare boom-frequency.h5 --test functions.unv"}},
      {"run",
       {"Time history of a multibody system",
        "Example:\n  bough run spinup.toml -o spinup.h5\n  bough run spinup.toml -o spinup.h5 --resume\n"
        "SIGINT (Ctrl-C), SIGTERM and SIGHUP write a checkpoint and end the file cleanly, exit code 3; a second Ctrl-C "
        "ends the program at once. --resume "
        "takes the system file of the run with another duration, other samples or limits; it refuses other changes. A "
        "worst relative energy error above energy_error_limit ends with exit code 3 too, the results are written."}},
      {"equilibrium",
       {"A state of rest, or of steady spin, of a multibody system",
        "Example:\n  bough equilibrium arm.toml -o rest.h5\n"
        "  bough linearize arm.toml --start-from rest.h5 -o arm-linear.h5\n"
        "Hinge rates of the system file are kept: other than zero they give a steady spin."}},
      {"linearize",
       {"A B C D, poles and zeros of a multibody system about a state",
        "Example:\n  bough linearize arm.toml -o arm-linear.h5 --mat arm.mat\n"
        "  bough linearize arm.toml --inputs shoulder,elbow --outputs tip:y --at 2.5 --json\n"
        "  bough linearize rotor.toml --equilibrium --sweep rate=0:6:25 -o campbell.h5\n"
        "  bough linearize launcher.toml --sweep speed=100:400:7 --sweep fill=0.1:1:4 --mat lpv.mat\n"
        "  bough linearize arm.toml --uncertain gain=4:6 --uncertain boom:eta1:frequency=0.95:1.05 --mat arm.mat\n"
        "  bough linearize arm.toml --break motor -o loop.h5 && bough response loop.h5"}},
      {"response",
       {"Frequency response, largest gain, margins and random response of a linear model",
        "Example:\n  bough linearize arm.toml --break motor -o loop.h5 && bough response loop.h5\n"
        "  bough response arm-linear.h5 --outputs tip:y --csv tip.csv\n"
        "  bough response arm-linear.h5 --psd motor=1e-4 --psd wind.csv -o random.h5\n"
        "  bough response satellite-linear.h5 --outputs sight --budget jitter.toml -o budget.h5 --csv budget.csv\n"
        "bough plot arm-linear.h5 --kind bode draws it."}},
      {"select",
       {"Ranks the modes of a body by component cost and picks those to keep",
        "Example:\n  bough select panel.h5 --number 12 -o small.h5\n"
        "  bough select panel.h5 satellite.toml --tolerance 0.001 -o small.h5\n"
        "  bough select panel.h5 slew.toml hold.toml --weight gyro=10 --keep 1,2 --response loss.svg\n"
        "  bough select slew.toml --number 12 --exchange -o small"}},
      {"export",
       {"Bodies, modes, matrices, results or a deck in the format of another program",
        "Example:\n  bough export spinup.h5 --to csv -o spinup.csv\n"
        "  bough export spinup.h5 --to csv --channel tip_deflection:y --channel /bodies/boom/eta\n"
        "  bough export spinup.h5 --to csv --channel events\n"
        "  bough export boom-modes.h5 --to vtu -o boom.vtu\n  bough export boom-modes.h5 --to csv --channel modes\n"
        "  bough export spinup.h5 --to pvd --every 10 -o spinup.pvd\n  bough export spinup.h5 --to gltf -o spinup.glb\n"
        "  bough export spinup.h5 --to uff --moving --every 10 -o spinup.uff\n"
        "  bough export boom.h5 --to mat -o boom.mat\n"
        "  bough export boom-modes.h5 --to uff -o boom.uff\n  bough export boom.h5 --to sid -o boom.SID_FEM\n"
        "  bough export boom.h5 --to mbdyn -o boom.fem\n  bough export boom.h5 --to flat -o boom.flat\n  bough export "
        "spinup.toml --to fmu --fmi 2 --channel tip_deflection:y -o spinup.fmu\n  bough export boom.bdf --to bdf -o "
        "plain.bdf\n  bough export panel.bdf --to extseout -o panel"}},
      {"plot",
       {"Curves of results against time, or a linear model, as a picture",
        "Example:\n  bough plot spinup.h5 --sensor tip_deflection:y -o tip.svg\n"
        "  bough plot spinup.h5 spinup-no-kg.h5 --sensor tip_deflection:y --y-min -1.2 --y-max 0.2 -o tip.svg\n"
        "  bough plot spinup.h5 --sensor /bodies/boom/eta:1 --psd --term\n"
        "  bough plot a.h5 b.h5 --sensor tip:y --difference --window 0,10 -o difference.svg\n"
        "  bough plot outcomes.h5 --sensor tip_max --x density -o scatter.svg\n"
        "  bough plot arm-linear.h5 --kind bode --outputs tip:y -o bode.svg\n"
        "  bough plot campbell.h5 --kind campbell -o campbell.svg"}},
      {"report",
       {"One HTML page of results, bodies, modes, linear models, for any browser",
        "The page loads nothing from anywhere. Bodies of a run are drawn from the files that it names, or from those "
        "given "
        "here.\nExample:\n  bough report spinup.h5 boom.h5 -o spinup.html"}},
      {"info", {"What an HDF5 file of Bough, a .FLX or a flat body file holds", "Example:\n  bough info boom.h5"}},
      {"init",
       {"A ready example to start from, or the files for a deck: spinup, hub, two-link, ...",
        "Example:\n  bough init\n  bough init spinup\n  bough init hub -o my-hub\n  bough init arm.bdf --hinge 1"}},
      {"batch",
       {"One job over a grid, a list or a sample of parameters; resumable",
        "Example:\n  bough batch study.toml --dry-run\n  bough batch study.toml -j 8 -o study\n"
        "  bough batch study.toml --shard 3/10 -o /scratch/study\n"
        "  bough batch study.toml --merge part-1 part-2 part-3 -o study\n"
        "  mpirun -n 4 bough batch study.toml -o study\n"
        "Finished cases are skipped: the same command goes on after Ctrl-C or a kill. Exit code 3 when a case "
        "failed."}},
      {"edit",
       {"Change a system or body file by commands, at a terminal or from a script",
        "Commands: list, show, add, set, unset, delete, rename, copy, undo, redo, check, run, reduce, plot, diff, "
        "save, "
        "quit; 'help' in the session explains them, and every key. A script comes on standard input and ends at its "
        "first "
        "wrong line.\n"
        "Example:\n  bough edit spinup.toml\n  echo 'set simulation.duration=5\n  save' | bough edit spinup.toml"}},
      {"convert",
       {"A deck, system, body or flexible-body file in other units; comments and order are kept",
        "Units: m mm cm um km in ft, kg g mg t tonne lbm slug slinch, N mN kN MN lbf kgf, s ms min h; of mass, length, "
        "force and time three give the fourth.\n"
        "Example:\n  bough convert wing.bdf --units mm-N-tonne:m-kg-s -o wing-si.bdf\n"
        "  bough convert spinup.toml --units m-kg-s:mm-N-tonne --radians -o mm/spinup.toml"}},
      {"studio",
       {"An interactive page of the files in this folder: deck, body, system, run",
        "The page is served on 127.0.0.1 alone, under an address with a random token. It reads and writes files in the "
        "folder where it was started and below.\nExample:\n  bough studio\n  bough studio wing.bdf --no-open --port "
        "8080"}},
  };
  const auto at = helps.find(command);
  BOUGH_DEMAND(at != helps.end());
  return at->second;
}

}  // namespace bough::cli
