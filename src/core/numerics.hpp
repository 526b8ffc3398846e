// The tuning constants of a time step. Those of one algorithm alone (untangling, stretch limits, single precision) are
// in its file; others follow from a scene, from theory, from rounding, or from the size of CPU caches.
#pragma once

namespace weft {

/// Tuned on the shipped scenes and those of tests/bench/scenes: cloth of 0.05 to 1 kg/m², spacings of 1 cm to 1 m,
/// steps of 1 to 40 ms. Comments give meaning, unit, and the effect of other values, as far as it was measured
/// ("Larger:" precedes the effect of a larger value, "0:" that of 0). Members without a unit are ratios or counts.
/// `tests/tools/change_numerics.sh` shows which tests fail if a member is ten times as large.
struct Numerics {
  /// The linear solver (src/physics/solver).
  struct Linear {
    /// Trace of a particle's 3×3 block of the matrix, relative to the sum of `LinearSystem::norm_weights` over the rows
    /// of its diagonal block. If any particle exceeds it, the multigrid levels correct each aggregate as a whole
    /// instead of interpolating between aggregates (Preconditioner). Larger: systems with slender cells or a viscosity
    /// of 1e4 N·s/m are not solved; smaller: soft cloth takes twice as many iterations.
    double stiff_particle = 1e3;
    /// Number of last iterations from which the error is estimated: `least_delay`, or all so far divided by
    /// `delay_fraction` if that is more. Fewer: solves end on a plateau, and cloth with a viscosity of 1e4 N·s/m gains
    /// energy.
    int least_delay = 3;
    int delay_fraction = 5;
    /// Maximum number n of aggregates of cloth on the coarsest level, or one per cloth if there are more cloths; its
    /// dense factorisation takes 9 n³ multiplications.
    int coarsest_aggregates = 70;
  } linear;

  /// Newton's method (src/physics/integrator).
  struct Newton {
    /// Allowed linear error, relative to the allowed Newton error. A diagonal block (a cloth or rigid body) whose error
    /// is below this fraction of the allowed Newton error is not solved again (but see `patience`). 1: fewer
    /// iterations, but more strain.
    double linear_fraction = 0.8;
    /// Factor on `linear_fraction` and on the linear tolerance for the midpoint rule, which damps nothing. Larger: flat
    /// sheets fold in free fall.
    double undamped = 0.1;
    /// `slope_left`: slope (residual · direction) at which a line search ends, relative to that at its start (smaller:
    /// more evaluations; 0.7: eight sheets that settle take a fifth more iterations). `line_trials`: maximum number of
    /// evaluations.
    double slope_left = 0.5;
    int line_trials = 6;
    /// Newton iterations after which the trajectory is checked for contacts that only the solve reveals.
    int check_after = 4;
    /// Number of Newton iterations of a step in which friction follows the normal forces. Also the number of times that
    /// a solve may continue from cloth that was pushed apart (0: a ring takes four times the steps). After this number
    /// of iterations, errors below unseen_velocity() and, with implicit Euler, below `velocity_ratio` times its local
    /// velocity error, are allowed; after half of it, each linear solve includes all diagonal blocks. Larger:
    /// friction and normal forces, or cloths that press on each other, oscillate.
    int patience = 20;
    double velocity_ratio = 0.5;
    /// Time for which a velocity error is assumed to displace cloth [s]. Shorter: the solver dominates the error;
    /// longer: more iterations.
    double lasting_time = 0.15;
    /// Visibility threshold of acceleration [m/s²], and of the velocity that it leads to in `lasting_time` [m/s]. As
    /// bounds of errors, both are multiplied by `solver.newton_tolerance`.
    double unseen_acceleration = 0.01;
    double unseen_velocity() const { return unseen_acceleration * lasting_time; }
    /// Friction, relative to its limit, above which a diagonal block counts as about to slide.
    double about_to_slide = 0.9;
    /// Largest motion since the rows of a cloth were assembled, in particle spacings, at which Newton's method reuses
    /// them. Larger: more iterations.
    double stale_motion = 0.005;
  } newton;

  /// Step sizes from `time.tolerance` (src/physics/integrator/step_control.cpp), and after rejections.
  struct Steps {
    /// Error that the controller aims at, relative to the tolerance. Nearer to 1: more steps are rejected.
    double aim = 0.7;
    /// Minimum and maximum factor between successive steps; after a rejection, the maximum is 1. A larger maximum: BDF2
    /// propagates its error.
    double least_factor = 0.2;
    double largest_factor = 1.5;
    /// Shortest step that errors ask for [s]: at 10 m/s, cloth moves 1e-4 m in it. A step that is not solved is halved
    /// further, but ends the run if it is shorter than this.
    double least = 1e-5;
    /// Maximum speed of cloth at rest [m/s]; see StepLoop::may_rest(). A frame at rest is one step.
    double rest_velocity = 0.02;
  } steps;

  /// Contacts (src/physics/collision).
  struct Contact {
    /// Detection distance, relative to the largest activation distance. Smaller: contacts are found late in a step.
    double detection = 1.5;
    /// Verlet margin of near features, in detection distances: motion up to which the search reuses its lists.
    /// Candidate pairs have twice this margin while no vertex moves that far in a step, kept closest points
    /// (`search.coherence`) half of it. Larger: longer lists; smaller: more searches. Also the distance between an
    /// obstacle's arc and its chord above which a step is halved, and the motion of an obstacle in a step below which
    /// shorter steps find no more space.
    double margin = 0.25;
    /// Maximum contact thickness of cloth other than ropes, in particle spacings. Larger: a sheared sheet collides with
    /// itself.
    double thickness_of_spacing = 0.25;
    /// Minimum contact stiffness in m/h² (m: weighted mean mass of the contact's particles, or of the lighter side
    /// against a rigid body; h: `time.step`). In one step of implicit Euler, a particle then goes in by at most a
    /// hundredth of the distance that it would cover.
    double inertial_stiffness = 100;
    /// Stiffening of the normal force k d (1 + stiffening (d/r)⁴) at depth d, with stiffness k and activation distance
    /// r. 10: tips penetrate; 1000: more iterations.
    double stiffening = 100;
    /// Width of the three ramps along which the stiffness of an edge pair falls from full to zero: the sine of the
    /// angle outside of an edge's wedge (`Proximity::outside_wedge`), up to `fade`; and, if cloth takes part, the fold,
    /// from twice `fade` to half of it, and the place along an edge, from the fraction `fade` to its end. 0: contacts
    /// switch on and off; larger: only separating planes keep crossing creases apart.
    double fade = 0.1;
    double flat_fold() const { return 0.5 * fade; }
    /// Slip velocity below which friction sticks [m/s]; if contacts are springs, `stick_spacings` of the smallest
    /// particle spacings per second if that is more. Larger: cloth creeps down slopes; smaller: a stiffer system.
    double stick_velocity = 2e-4;
    double stick_spacings = 0.002;
    /// Slip velocity, in stick velocities, at which the coefficient has fallen from static to sliding friction.
    double slide_velocity = 5;
    /// Closing velocity from which a contact is an impact [m/s]; a slower contact counts as one in proportion to its
    /// velocity (BDF2 only). Larger: impacts in short steps rebound (five balls that meet keep a quarter of their
    /// energy with 0.1, and a fifth, which is right, with 0.05).
    double impact_velocity = 0.05;
    /// How often in a step a contact that has begun to slide may stick again when it slides back. 0: ribbons take 1.4
    /// times the iterations; 20: friction of 10 does not settle.
    int returns = 2;
    /// Shortest time in which a contact opens by its activation distance [s]. 0: in steps of 1 ms and less, surfaces
    /// that are close already when they come into contact rebound with up to eight times the energy in play.
    double opening_time = 5e-3;
    /// Relative stiffness of contacts that push pinched cloth out while there is no space.
    double depenetration_stiffness = 0.05;
  } contact;

  /// Separating planes, which guarantee that nothing intersects (src/physics/collision/response).
  struct Separation {
    /// Minimum gap between two triangles along the normal of their separating plane, at the end of a step [m]. Smaller:
    /// rounding decides; larger: thin cloth fails.
    double least_gap = 1e-6;
    /// Gap that pushing apart restores [m], a tenth of the default thickness of a fabric; at most half of the gap at
    /// the start, but at least twice `least_gap`.
    double restored_gap = 2e-4;
    /// Rounds of pushing apart. `rounds` / 2 rounds of backtracking by halves follow, then `rounds` of backtracking
    /// entirely. Fewer: particles move back farther than necessary.
    int rounds = 24;
  } separation;

  /// Velocity constraints of the seed, the paper that README names (`contact.response`).
  struct Walls {
    /// Fraction of a missing distance that a step restores (seed, Eq. 4).
    double correction = 0.2;
    /// Sine of the angle between two walls below which the second one holds no direction of its own.
    double same_direction = 0.05;
    /// Maximum number of changes of a particle's constraints in a step (`flips`), of solves in a step (`solves`), and
    /// of walls per particle (`most`).
    int flips = 3;
    int solves = 6;
    int most = 8;
    /// Accelerations [m/s²] and relative changes of friction below which a change of constraints needs no further
    /// solve.
    double negligible_acceleration = 0.5;
    double negligible_change = 0.2;
  } walls;

  /// Repairs of a step (src/physics/simulation/step_loop.cpp).
  struct Repair {
    /// How often a step is rejected before cloth may count as pinched, and before too much stretch or added energy is
    /// accepted. How often a trajectory is halved in the search for separating planes (0: a tenth more iterations). How
    /// often a step is tried anew with obstructed pins released, before pinned particles may be pushed.
    int halvings = 3;
    /// Strain that pushing apart may add. If it adds more, or more energy than Energy::doubtful_gain, the solve
    /// continues; once it may not continue any more, only added energy rejects the step. Larger: single frames show
    /// strain of 0.1 and more.
    double added_strain = 0.05;
    /// Energy gain, relative to the kinetic and elastic energy at the start of the step, above which an unfinished
    /// solve starts anew with fixed normal forces.
    double astray_energy = 3;
    /// Maximum stretch at the end of a step beyond that at its start or, if that is larger, the limit; in stretch
    /// limits.
    double overstretch = 2;
  } repair;

  /// Pinned particles that an obstacle or other cloth keeps from their targets: they lag
  /// (src/physics/simulation/yielding_pins.cpp).
  struct Pins {
    /// Maximum speed [m/s], relative to its target, at which a particle returns.
    double return_velocity = 1;
    /// Maximum force on a lagging particle: the largest of `acceleration` [m/s²] times its mass; `weights` times the
    /// weight of the cloth, divided among all particles of the pin; the same divided among those that lag, but at most
    /// `most_acceleration` [m/s²] times its mass.
    double acceleration = 2000;
    double weights = 3;
    double most_acceleration = 20000;
  } pins;

  /// Rigid bodies that move by forces (forces/rigidity.hpp).
  struct Bodies {
    /// Squared angular frequency of their stretching [1/`time.step`²]. Smaller: an impact of 1 m/s compresses them by
    /// more than 1e-6 m; larger: rounding in single precision.
    double rigidity = 1e4;
    /// Contact thickness [m], but at most `thickness_of_size` times the smallest standard deviation of the places of
    /// the body's mass. Smaller: bodies at rest on each other rattle; larger: gaps are visible.
    double thickness = 5e-4;
    double thickness_of_size = 0.1;
  } bodies;

  /// Energy without a source (src/physics/simulation/energy_bound.cpp), relative to the energy in play.
  struct Energy {
    /// `failing_gain`: gain above which a run fails (with contact only for the midpoint rule, as the others damp
    /// contact); also the work of the residual above which it warns. `doubtful_gain`: gain above which a run warns;
    /// also the gain that pushing apart may add to a step.
    double failing_gain = 0.3;
    double doubtful_gain = 0.1;
    /// Energy that is never an error [J/kg]: enough to lift cloth by 1 cm.
    double negligible = 0.1;
  } energy;
};

extern const Numerics numerics;

}  // namespace weft
