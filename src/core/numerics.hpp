// All tuning constants of the physics. Other constants follow from a scene, from theory, from rounding, or from the
// size of CPU caches.
#pragma once

namespace weft {

/// Tuned on the shipped scenes and those of tests/bench/scenes: cloth of 0.05 to 1 kg/m², spacings of 1 cm to 1 m,
/// steps of 1 to 40 ms. Each comment gives meaning, unit, and the effect of other values. Members without a unit are
/// ratios or counts. `tests/tools/change_numerics.sh` shows which tests fail if a member is ten times as large.
struct Numerics {
  /// The linear solver (src/solver).
  struct Linear {
    /// Multigrid: fraction that a member takes from the aggregates of its neighbours. 0: aggregates move as wholes, and
    /// iterations grow with finer meshes.
    double interpolation = 0.6;
    /// Stiffness between aggregates, relative to the next finer level. 1: plain sums, which are too stiff.
    double level_stiffness = 0.5;
    /// Weight of contacts on aggregates. 1: a quarter more iterations in scenes with many contacts.
    double contact_weight = 2;
    /// Stiffness of a particle, relative to the mass-weighted norm of its whole block, from which aggregates move as
    /// wholes. Larger: threads of 1e6 N/m take ten times the iterations; smaller: soft cloth takes twice as many.
    double stiff_particle = 1e3;
    /// Cost of the incomplete factor, in iterations; it pays off if more than 2.5 times as many are left.
    int factor_cost = 40;
    /// Weight of the incomplete factor beside the multigrid levels. 1: long waves count twice, twice the iterations.
    double factor_weight = 16;
    /// First diagonal shift if the factorisation fails, relative to the diagonal. 0.1: a third more iterations.
    double factor_shift = 1e-3;
    /// Number of last iterations from which the error is estimated: at least `least_delay`, and one in `delay_fraction`
    /// of all. Fewer: solves end on a plateau, and a viscosity of 1e4 N·s/m gains energy.
    int least_delay = 3;
    int delay_fraction = 5;
    /// Maximum number of aggregates on the coarsest level; its dense factorisation costs 9 times their third power.
    int coarsest_aggregates = 70;
    /// Ratio of length to width from which an aggregate grows in width only. Larger: strips of slender cells swing with
    /// 0.8 of their energy.
    double slender_aggregate = 2;
  } linear;

  /// Newton's method (src/integrator).
  struct Newton {
    /// Allowed linear error, relative to the allowed Newton error; a block below it is not solved again.
    double linear_fraction = 0.8;
    /// Factor on `linear_fraction` and on the linear tolerance for the midpoint rule, which damps nothing. Larger: flat
    /// sheets fold in free fall.
    double undamped = 0.1;
    /// Slopes behind and before the minimum, relative to the initial one, that end a line search.
    double overshoot = 0.7;
    double undershoot = 0.5;
    /// Longest step of a line search, relative to the solution of the linear system; maximum number of evaluations.
    double longest_search = 4;
    int line_trials = 6;
    /// Newton iteration from which compressed threads count with the absolute value of their stiffness. 0: cloth at
    /// rest takes four times the iterations; 4: folding cloth a quarter more.
    int clamped_iterations = 2;
    /// Iterations after which the trajectory is checked for contacts that only the solve reveals.
    int check_after = 4;
    /// Linearisations of a step in which friction follows the normal forces. After as many, a velocity error below the
    /// visibility threshold, and half of Euler's velocity error, are allowed; after half as many, all blocks are solved
    /// together. Larger: friction and normal forces, or cloths that press on each other, oscillate.
    int patience = 20;
    double velocity_ratio = 0.5;
    /// Time for which a velocity error counts [s]. Shorter: the solver dominates the error; longer: more iterations.
    double lasting_time = 0.15;
    /// Visibility thresholds of acceleration [m/s²] and velocity [m/s], to be multiplied by the tolerance.
    double unseen_acceleration = 0.01;
    double unseen_velocity = 1e-3;
    /// Allowed sliding error of a whole cloth, relative to the allowed velocity error. Larger: sheets slide too slowly.
    double sliding_fraction = 0.2;
    /// Friction, relative to its limit, from which a cloth counts as about to slide.
    double about_to_slide = 0.9;
    /// Motion since the last linearisation, in particle spacings, that keeps rows of the matrix. Larger: more
    /// iterations.
    double stale_motion = 0.005;
  } newton;

  /// Step sizes from `time.tolerance` (src/integrator/step_control.cpp), and after rejections.
  struct Steps {
    /// Error that the controller aims at, relative to the tolerance. Nearer to 1: more steps are rejected.
    double aim = 0.7;
    /// Relative change of a step size that does not justify a new matrix.
    double kept_change = 0.1;
    /// Minimum and maximum factor between successive steps. Larger: BDF2 propagates its error.
    double least_factor = 0.2;
    double largest_factor = 1.5;
    /// Minimum step size [s], 1e-4 m at 10 m/s: errors do not reduce a step below it, and unsolved steps below it end
    /// the run.
    double least = 1e-5;
    /// Maximum growth between steps after a rejection. Larger: cloth that is wrung is rejected again and again.
    double recovery = 1.1;
    /// Cloth rests if it is slower than this [m/s] and its acceleration is below the visibility threshold; then a frame
    /// is one step.
    double rest_velocity = 0.02;
  } steps;

  /// Contacts (src/collision).
  struct Contact {
    /// Detection distance, relative to the largest activation distance. Smaller: contacts are found late in a step.
    double detection = 1.5;
    /// Verlet margin of near features, in detection distances. Candidate pairs in slow steps have twice, kept closest
    /// points (`search.coherence`) half of it. Larger: longer lists; smaller: more searches.
    double margin = 0.25;
    /// Maximum contact thickness, in particle spacings. Larger: a sheared sheet collides with itself.
    double thickness_of_spacing = 0.25;
    /// Contact stiffness in m/h² (particle mass, `time.step`): impacts stop within a hundredth of a step's trajectory.
    double inertial_stiffness = 100;
    /// Stiffening as the gap closes, k d (1 + stiffening (d/r)⁴). 10: tips penetrate; 1000: more iterations.
    double stiffening = 100;
    /// Range over which an edge pair fades out: between twice and half of this fold of its edges (a sum of sines of
    /// half the angles), over this sine outside of its wedge, and over this fraction of an edge at its ends. 0:
    /// contacts switch on and off; larger: only separating planes keep crossing creases apart.
    double fade = 0.1;
    double flat_fold() const { return 0.5 * fade; }
    /// Slip velocity below which friction sticks [m/s], or in particle spacings per second if that is more. Larger:
    /// cloth creeps down slopes; smaller: a stiffer system.
    double stick_velocity = 2e-4;
    double stick_spacings = 0.002;
    /// Slip velocity, in stick velocities, from which friction is no longer static.
    double slide_velocity = 5;
    /// How often in a step a contact that slides back may stick again. 0: ribbons take 1.4 times the iterations; 20:
    /// friction of 10 does not settle.
    int returns = 2;
    /// Factor on the stiffness of a contact with a moving obstacle after each failure that pushed its cloth apart;
    /// maximum number of factors. 0: cloth that a plate hits at 30 m/s takes 1.5 times the iterations.
    double hardening = 3;
    int hardenings = 5;
    /// Depenetration speed of pinched cloth [m/s], 8 mm per frame; its relative stiffness while there is no space.
    double depenetration_velocity = 0.2;
    double depenetration_stiffness = 0.05;
  } contact;

  /// Separating planes, which guarantee that nothing intersects (src/collision/response).
  struct Separation {
    /// Minimum gap along a plane at the end of a step [m]. Smaller: rounding decides; larger: thin cloth fails.
    double least_gap = 1e-6;
    /// Gap that pushing apart restores [m]: a tenth of a fabric's thickness.
    double restored_gap = 2e-4;
    /// Number of halvings of a trajectory in the search for planes. 0: a tenth more iterations.
    int halvings = 3;
    /// Rounds of pushing apart; half as many rounds of backtracking by halves follow. Fewer: particles move back
    /// farther than necessary.
    int rounds = 24;
    /// Distance between an obstacle's arc and its chord, in detection distances, above which a step is halved; also the
    /// motion of an obstacle in a step below which shorter steps find no more space.
    double creep = 0.25;
  } separation;

  /// Velocity constraints of the paper (`contact.response`).
  struct Walls {
    /// Fraction of a missing distance that a step restores (Eq. 4).
    double correction = 0.2;
    /// Sine of the angle between two walls below which they count as one.
    double same_direction = 0.05;
    /// Maximum number of changes between sticking and sliding in a step, of solves in a step, of walls per particle.
    int flips = 3;
    int solves = 6;
    int most = 8;
    /// Accelerations [m/s²] and relative changes of friction that are left to the next step.
    double negligible_acceleration = 0.5;
    double negligible_change = 0.2;
  } walls;

  /// Repairs of a step (src/simulation/step_loop.cpp).
  struct Repair {
    /// Halvings before cloth counts as pinched, and before a diverged or overstretched solve is accepted.
    int halvings = 3;
    /// How often a solve continues from cloth that was pushed apart. 0: a ring takes four times the steps.
    int restarts = 16;
    /// Energy, relative to the energy in play, and strain that pushing apart may add. Beyond that the solve continues;
    /// if it cannot, the step is halved for the energy alone.
    double added_energy = 0.1;
    double added_strain = 0.05;
    /// Energy, relative to the energy in play, from which an unfinished solve starts anew with fixed normal forces.
    double astray_energy = 3;
    /// Maximum increase in a step: of stretch, in stretch limits; of strain, by an unfinished solve.
    double overstretch = 2;
    double diverged_strain = 0.5;
    /// Maximum number of attempts with released pins.
    int tries = 4;
  } repair;

  /// Pins that an obstacle keeps from their position (src/simulation/yielding_pins.cpp).
  struct Pins {
    /// Velocity of the return [m/s]; lower bound of the velocity that forces are divided by [m/s].
    double return_velocity = 1;
    double slowest = 1e-3;
    /// Force on the pin: as acceleration [m/s²], in weights of the cloth, and as maximum acceleration [m/s²].
    double acceleration = 2000;
    double weights = 3;
    double most_acceleration = 20000;
  } pins;

  /// Rigid bodies that move by forces (forces/rigidity.hpp).
  struct Bodies {
    /// Squared frequency of their stretching [1/step²]. Smaller: an impact of 1 m/s compresses them by more than 1e-6
    /// m; larger: rounding in single precision.
    double rigidity = 1e4;
    /// Contact thickness [m], at most this fraction of the smallest standard deviation of the mass. Smaller: bodies at
    /// rest on each other rattle; larger: gaps are visible.
    double thickness = 5e-4;
    double thickness_of_size = 0.1;
  } bodies;

  /// Energy without a source (src/simulation/energy_bound.cpp), relative to the energy in play.
  struct Energy {
    /// Gain from which a run fails, also the work of the residual from which it warns; gain from which it warns.
    double failing_gain = 0.3;
    double doubtful_gain = 0.1;
    /// Energy that is never an error [J/kg]: lifts cloth by 1 cm.
    double negligible = 0.1;
  } energy;
};

extern const Numerics numerics;

}  // namespace weft
