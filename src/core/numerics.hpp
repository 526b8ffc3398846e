// The numbers that the physics is tuned with: all of them, in one place. What is not here follows from a scene, from
// theory, from rounding, or from the size of a machine's caches.
#pragma once

namespace weft {

/// Tuned on the shipped scenes and those of tests/bench/scenes: cloth of 0.05 to 1 kg/m², spacings of 1 cm to 1 m,
/// steps of 1 to 40 ms. Each member says what it is, with its unit, and what happens outside of its range. Members
/// without a unit are ratios or counts. `tests/tools/change_numerics.sh` shows which tests fail if a member is ten
/// times as large.
struct Numerics {
  /// The linear solver (src/solver).
  struct Linear {
    /// Multigrid: what a member takes from the neighbours of its aggregate. 0: aggregates move as wholes, and
    /// iterations grow with finer meshes.
    double interpolation = 0.6;
    /// Stiffness between aggregates that is left from level to level. 1: that of the sums, which is too stiff.
    double level_stiffness = 0.5;
    /// Weight of contacts on aggregates. 1: a quarter more iterations where much touches.
    double contact_weight = 2;
    /// Stiffness of a particle, relative to the mass-weighted norm of its whole block, from which aggregates move as
    /// wholes. Larger: threads of 1e6 N/m take ten times the iterations; smaller: soft cloth takes twice as many.
    double stiff_particle = 1e3;
    /// Iterations that making the incomplete factor costs; it pays if more than 2.5 times as many are left.
    int factor_cost = 40;
    /// Weight of the incomplete factor beside the multigrid levels. 1: long waves count twice, twice the iterations.
    double factor_weight = 16;
    /// First shift of an indefinite factorisation, relative to the diagonal. 0.1: a third more iterations.
    double factor_shift = 1e-3;
    /// The last iterations whose gain estimates the error: so many at least, and one in so many of all. Fewer: solves
    /// end on a plateau, and a viscosity of 1e4 N·s/m gains energy.
    int least_delay = 3;
    int delay_fraction = 5;
    /// Aggregates on the coarsest level, at most; its dense factorisation costs 9 times their third power.
    int coarsest_aggregates = 70;
    /// Length over width from which an aggregate grows in width only. Larger: strips of slender cells swing with 0.8 of
    /// their energy.
    double slender_aggregate = 2;
  } linear;

  /// Newton's method (src/integrator).
  struct Newton {
    /// What the linear solver may leave, relative to what Newton's method may; a block below that is not solved again.
    double linear_fraction = 0.8;
    /// The same, and the linear tolerance, of the midpoint rule relative to other methods: it damps nothing. Larger:
    /// flat sheets fold in free fall.
    double undamped = 0.1;
    /// Slopes behind and before the minimum, relative to the one at the start, that end a line search.
    double overshoot = 0.7;
    double undershoot = 0.5;
    /// Longest step of a line search, relative to the solution of the linear system; and evaluations at most.
    double longest_search = 4;
    int line_trials = 6;
    /// Iterations from which compressed threads count with the absolute value of their stiffness. 0: cloth at rest
    /// takes four times the iterations; 4: folding cloth a quarter more.
    int clamped_iterations = 2;
    /// Iterations after which the trajectory is checked for contacts that only the solve reveals.
    int check_after = 4;
    /// Linearisations of a step in which friction follows the normal forces, and after which an invisible velocity, and
    /// half of Euler's velocity error, may be left; after half as many all blocks are solved together. More: friction
    /// and normal forces, and cloths that press on each other, chase each other.
    int patience = 20;
    double velocity_ratio = 0.5;
    /// How long a wrong velocity counts [s]. Shorter: the solver decides the error; longer: more iterations.
    double lasting_time = 0.15;
    /// Acceleration and velocity below the visibility threshold, times the tolerance [m/s²], [m/s].
    double unseen_acceleration = 0.01;
    double unseen_velocity = 1e-3;
    /// Part of the allowed velocity by which whole cloths may slide wrongly. Larger: sheets on slopes slide too slowly.
    double sliding_fraction = 0.2;
    /// Friction, relative to its limit, from which a cloth counts as about to slide.
    double about_to_slide = 0.9;
    /// Motion since the last linearisation, in particle spacings, up to which rows of the matrix are kept. Larger: more
    /// iterations.
    double stale_motion = 0.005;
  } newton;

  /// Step sizes from `time.tolerance` (src/integrator/step_control.cpp), and after rejections.
  struct Steps {
    /// Error that is aimed at, relative to the tolerance. Nearer to 1: more steps are rejected.
    double aim = 0.7;
    /// Change of a step size that is not worth a new matrix.
    double kept_change = 0.1;
    /// Least and largest factor from one step to the next. Larger: BDF2 carries its error on.
    double least_factor = 0.2;
    double largest_factor = 1.5;
    /// Length below which no error shortens a step [s], 1e-4 m at 10 m/s, and a step that is not solved ends the run.
    double least = 1e-5;
    /// Growth from step to step after one was rejected. Larger: cloth that is wrung is rejected again and again.
    double recovery = 1.1;
    /// Cloth slower than this [m/s], and with no more acceleration than is visible, rests: a frame is one step.
    double rest_velocity = 0.02;
  } steps;

  /// Contacts (src/collision).
  struct Contact {
    /// Detection distance, relative to the largest activation distance. Smaller: contacts show late in a step.
    double detection = 1.5;
    /// Verlet margin of near features, in detection distances; of candidate pairs in slow steps twice, of kept closest
    /// points (`search.coherence`) half of it. Larger: longer lists; smaller: more searches.
    double margin = 0.25;
    /// Contact thickness, in particle spacings, at most. Larger: a sheared sheet pushes against itself.
    double thickness_of_spacing = 0.25;
    /// Stiffness in m/h² (particle mass, `time.step`): what arrives stops within a hundredth of its step's trajectory.
    double inertial_stiffness = 100;
    /// Stiffening as the gap closes, k d (1 + stiffening (d/r)⁴). 10: tips press through; 1000: more iterations.
    double stiffening = 100;
    /// An edge pair fades out between twice and half of this fold of its edges (a sum of sines of half the angles),
    /// over this sine outside of its wedge, and over this part of an edge at its ends. 0: contacts switch on and off;
    /// larger: creases that cross are kept apart by planes alone.
    double fade = 0.1;
    double flat_fold() const { return 0.5 * fade; }
    /// Slip velocity below which friction sticks [m/s], and in particle spacings per second if that is more. Larger:
    /// cloth creeps down slopes; smaller: a stiffer system.
    double stick_velocity = 2e-4;
    double stick_spacings = 0.002;
    /// Slip velocity, in stick velocities, from which friction is no longer static.
    double slide_velocity = 5;
    /// Times in a step that a contact which slides back sticks again. 0: a catwalk takes half as many iterations again;
    /// 20: friction of 10 does not settle.
    int returns = 2;
    /// Stiffness of a contact with a moving obstacle for each time that its cloth was pushed apart, and how often.
    double hardening = 3;
    int hardenings = 5;
    /// Depenetration velocity of pinched cloth [m/s]: 8 mm a frame; and its stiffness while there is no space.
    double depenetration_velocity = 0.2;
    double depenetration_stiffness = 0.05;
  } contact;

  /// The guarantee that nothing intersects (src/collision/response).
  struct Separation {
    /// Gap that a plane must show at the end of a step [m]. Smaller: rounding decides; larger: thin cloth fails.
    double least_gap = 1e-6;
    /// Gap that pushing apart restores [m]: a tenth of a fabric's thickness.
    double restored_gap = 2e-4;
    /// Halvings of a trajectory in which planes are searched. 0: a tenth more iterations.
    int halvings = 3;
    /// Rounds of pushing apart; then half as many of backtracking by halves. Fewer: particles go back farther than
    /// needed.
    int rounds = 24;
    /// Distance between an obstacle's arc and its chord, in detection distances, above which a step is halved; and
    /// motion of an obstacle in a step below which shorter steps find no more space.
    double creep = 0.25;
  } separation;

  /// The paper's velocity constraints (`contact.response`).
  struct Walls {
    /// Part of a missing distance that a step restores (Eq. 4).
    double correction = 0.2;
    /// Sine of an angle between walls below which they are one.
    double same_direction = 0.05;
    /// Changes between sticking and sliding within one step; solves of a step; walls of a particle.
    int flips = 3;
    int solves = 6;
    int most = 8;
    /// Accelerations [m/s²] and changes of friction that are left to the next step.
    double negligible_acceleration = 0.5;
    double negligible_change = 0.2;
  } walls;

  /// Repairs of a step (src/simulation/step_loop.cpp).
  struct Repair {
    /// Halvings before cloth counts as pinched, and before a diverging or overstretched solve is accepted.
    int halvings = 3;
    /// Times that a solve continues from where cloth was pushed apart. 0: a ring takes four times the steps.
    int restarts = 16;
    /// Energy, relative to that in play, and strain that pushing apart may add; energy for which the step is halved.
    double unfelt_energy = 0.1;
    double unfelt_strain = 0.05;
    double corrected_energy = 0.2;
    /// Energy, relative to that in play, from which an unfinished solve starts anew with kept normal forces.
    double astray_energy = 3;
    /// Limits to stretch, and strain of an unfinished solve, that a step may add.
    double overstretch = 2;
    double diverged_strain = 0.5;
    /// Tries with pins let go.
    int tries = 4;
  } repair;

  /// Pins that obstacles keep from their place (src/simulation/yielding_pins.cpp).
  struct Pins {
    /// Velocity of its return [m/s], and the least that forces are divided by [m/s].
    double return_velocity = 1;
    double slowest = 1e-3;
    /// Force on it: acceleration [m/s²], weights of the cloth, and acceleration at most [m/s²].
    double acceleration = 2000;
    double weights = 3;
    double most_acceleration = 20000;
  } pins;

  /// Bodies that forces move (forces/rigidity.hpp).
  struct Bodies {
    /// Squared frequency of their stretching, in 1/step². Smaller: an impact of 1 m/s compresses them by more than
    /// 1e-6 m; larger: rounding in single precision.
    double rigidity = 1e4;
    /// Contact thickness [m], and in least deviations of their mass at most. Smaller: bodies at rest on each other
    /// rattle; larger: gaps show.
    double thickness = 5e-4;
    double thickness_of_size = 0.1;
  } bodies;

  /// Energy without a source (src/simulation/energy_bound.cpp), relative to the energy in play.
  struct Energy {
    /// Gain from which a run fails, and work of the residual that is warned of; and gain that is warned of.
    double failing_gain = 0.3;
    double doubtful_gain = 0.1;
    /// Energy that is no error [J/kg]: lifts cloth by 1 cm.
    double negligible = 0.1;
  } energy;
};

extern const Numerics numerics;

}  // namespace weft
