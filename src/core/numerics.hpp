// The tuned constants of a time step. Constants of one algorithm (untangling, stretch limits, single precision) are in
// the file of that algorithm.
#pragma once

namespace weft {

/// Tuned on the shipped scenes and those of tests/bench/scenes: cloth of 0.05 to 1 kg/m², spacings of 1 cm to 1 m,
/// steps of 1 to 40 ms. "Larger:" precedes the measured effect of a larger value, "0:" that of 0. Members without a
/// unit are ratios or counts. `tests/tools/change_numerics.sh` shows which tests fail if a member is ten times as
/// large.
struct Numerics {
  /// The linear solver (src/physics/solver).
  struct Linear {
    /// A particle is stiff if the trace of its 3×3 block of the matrix exceeds this value times the sum of
    /// `LinearSystem::norm_weights` over its cloth. With any stiff particle, the multigrid levels correct each
    /// aggregate as a whole instead of interpolating between aggregates (Preconditioner). Larger: systems with slender
    /// cells or a viscosity of 1e4 N·s/m are not solved; smaller: soft cloth takes twice as many iterations.
    double stiff_particle = 1e3;
    /// The last max(`min_error_window`, n / `error_window_divisor`) of n iterations estimate the error. Fewer: solves
    /// end on a plateau, and cloth with a viscosity of 1e4 N·s/m gains energy.
    int min_error_window = 3;
    int error_window_divisor = 5;
    /// Maximum number n of cloth aggregates on the coarsest level; one per cloth if there are more cloths. The dense
    /// factorisation of that level takes 9 n³ multiplications.
    int coarsest_aggregates = 70;
  } linear;

  /// Newton's method (src/physics/integrator).
  struct Newton {
    /// Allowed linear error, relative to the allowed Newton error. A diagonal block (a cloth or rigid body) whose error
    /// is below this fraction of the allowed Newton error is not solved again (but see `slow_after`). 1: fewer
    /// iterations, but more strain.
    double linear_fraction = 0.8;
    /// Factor on `linear_fraction` and on `solver.linear_tolerance` for the midpoint rule, which damps nothing. Larger:
    /// flat sheets fold in free fall.
    double midpoint_tightening = 0.1;
    /// `slope_left`: slope (residual · direction) at which a line search ends, relative to the slope at its start.
    /// Smaller: more evaluations; larger: more iterations. `line_trials`: maximum number of evaluations.
    double slope_left = 0.5;
    int line_trials = 6;
    /// Newton iterations after which the trajectory is checked for contacts that only the solve reveals.
    int check_after = 4;
    /// Newton iterations after which a solve counts as slow. Friction then keeps its normal forces. Velocity errors
    /// below unseen_velocity() or, with implicit Euler, below `velocity_ratio` times the local velocity error are then
    /// allowed. From half of this number on, each linear solve includes all diagonal blocks. A solve also continues at
    /// most this many times from cloth that was pushed apart (0: tests/bench/scenes/ring.toml takes four times the
    /// steps). Larger: friction and normal forces, or cloths that press on each other, oscillate.
    int slow_after = 20;
    double velocity_ratio = 0.5;
    /// Time for which a velocity error is assumed to displace cloth [s]. Shorter: most of a run's error comes from the
    /// solver; longer: more iterations.
    double lasting_time = 0.15;
    /// Visibility thresholds of acceleration [m/s²] and velocity [m/s]. As bounds of errors, both are multiplied by
    /// `solver.newton_tolerance`.
    double unseen_acceleration = 0.01;
    double unseen_velocity() const { return unseen_acceleration * lasting_time; }
    /// Friction, relative to its limit, above which a diagonal block counts as about to slide.
    double about_to_slide = 0.9;
    /// Newton's method reuses the matrix rows of a cloth while no particle has moved farther than this since their
    /// assembly, in particle spacings. Larger: more iterations.
    double stale_motion = 0.005;
  } newton;

  /// Step sizes from `time.tolerance` (src/physics/integrator/step_control.cpp), and after rejections.
  struct Steps {
    /// Error that the controller aims at, relative to the tolerance. Nearer to 1: more steps are rejected.
    double aim = 0.7;
    /// Minimum and maximum ratio of a step to the one before; after a rejection, the maximum is 1. A larger maximum:
    /// BDF2 amplifies earlier errors.
    double least_factor = 0.2;
    double largest_factor = 1.5;
    /// Shortest step that the error control chooses [s]. Steps that are not solved are halved below it; the run ends if
    /// such a step is not solved either.
    double min_step = 1e-5;
    /// Maximum speed of cloth at rest [m/s]; see StepLoop::may_rest().
    double rest_velocity = 0.02;
  } steps;

  /// Contacts (src/physics/collision).
  struct Contact {
    /// Detection distance, relative to the largest activation distance. Smaller: contacts are found late in a step.
    double detection = 1.5;
    /// Verlet margin m of near features, in detection distances: motion up to which the search reuses its lists.
    /// Larger: longer lists; smaller: more searches. Four other bounds follow from m, in detection distances:
    /// - 2 m: margin of candidate pairs; without margin if a vertex moves farther than that in a step,
    /// - m / 2: motion up to which `search.coherence` keeps closest points,
    /// - m: distance between an obstacle's arc and its chord above which a step is halved,
    /// - m: motion of all obstacles in a step below which shorter steps find no more space.
    double margin = 0.25;
    /// Maximum contact thickness of cloth other than ropes, in particle spacings. Larger: a sheared sheet collides with
    /// itself.
    double thickness_of_spacing = 0.25;
    /// Minimum contact stiffness in m/h² (m: weighted mean mass of the contact's particles, or of the lighter side
    /// against a rigid body; h: `time.step`). In one step of implicit Euler, a particle then penetrates by at most a
    /// hundredth of its motion without contact.
    double inertial_stiffness = 100;
    /// Stiffening of the normal force k d (1 + stiffening (d/r)⁴) at depth d, with stiffness k and activation distance
    /// r. 10: tips penetrate; 1000: more iterations.
    double stiffening = 100;
    /// Width w of the ramps along which the stiffness of a pair falls to zero (stiffness_fraction()). 0: contacts
    /// switch on and off; larger: only separating planes keep crossing creases apart. Ramps:
    /// - the sine of the angle outside of the wedge of an edge or vertex (`Proximity::outside_wedge`), from 0 to w,
    /// - of edge pairs with cloth, the fold: the sum of the sines inside of both wedges, from 2 w to w / 2,
    /// - of edge pairs with cloth, the place along an edge, from the fraction w to the end.
    double ramp_width = 0.1;
    double flat_fold() const { return 0.5 * ramp_width; }
    /// Slip velocity below which friction sticks [m/s]. If contacts are springs, it is at least `stick_spacings` [1/s]
    /// times the smallest particle spacing. Larger: cloth creeps down slopes; smaller: a stiffer system.
    double stick_velocity = 2e-4;
    double stick_spacings = 0.002;
    /// Slip velocity, in stick velocities, from which the coefficient is that of sliding friction.
    double slide_velocity = 5;
    /// Closing velocity from which BDF2 treats a contact as a full impact [m/s]; below, in proportion to the velocity.
    /// Larger: impacts in short steps rebound.
    double impact_velocity = 0.05;
    /// How often in a step a contact that has begun to slide may stick again when it slides back. 0:
    /// tests/bench/scenes/ribbons_in_half_pipe.toml takes 1.4 times the iterations; 20: friction of 10 does not settle.
    int max_resticks = 2;
    /// Time in which the activation distance of a new contact grows from the gap to its full value [s]. 0: in steps of
    /// 1 ms or less, surfaces that are already close when a contact appears fly apart, and gain energy.
    double range_growth_time = 5e-3;
    /// Stiffness of contacts that push pinched cloth out while its exit is blocked, relative to that of other contacts.
    double blocked_exit_factor = 0.05;
  } contact;

  /// Separating planes, which guarantee that nothing intersects (src/physics/collision/response).
  struct Separation {
    /// Minimum gap between two triangles along the normal of their separating plane, at the end of a step [m]. Smaller:
    /// rounding decides; larger: thin cloth fails.
    double least_gap = 1e-6;
    /// Pushing apart restores the gap max(2 `least_gap`, min(`restored_gap`, half of the gap at the start)) [m].
    double restored_gap = 2e-4;
    /// Rounds of pushing apart. Then particles move back: in `rounds` / 2 rounds by half of their motion, in `rounds`
    /// more to where the step began. Fewer: particles move back farther than necessary.
    int rounds = 24;
  } separation;

  /// Velocity constraints of Etzmuß et al. (2001), if `contact.response` selects them.
  struct Walls {
    /// Fraction of a missing distance that a step restores (γ of their Eq. 4).
    double correction = 0.2;
    /// A wall does not constrain a particle if the sine of the angle between its normal and the span of the normals of
    /// earlier walls is smaller.
    double min_independent_sine = 0.05;
    /// Maximum number of changes of a particle's constraints in a step (`flips`), of solves in a step (`solves`), and
    /// of walls per particle (`max_walls`).
    int flips = 3;
    int solves = 6;
    int max_walls = 8;
    /// Changes of constraints below these bounds need no further solve: of the constraint force per mass [m/s²], and of
    /// friction relative to its limit.
    double negligible_acceleration = 0.5;
    double negligible_change = 0.2;
  } walls;

  /// Repairs of a step (src/physics/simulation/step_loop.cpp).
  struct Repair {
    /// A retry ends before a compromise:
    /// - after so many rejections of a step, cloth may count as pinched, and much added energy is accepted,
    /// - after so many halvings of a trajectory, the search for its separating planes ends (0: a tenth more
    ///   iterations),
    /// - after so many repeats of a step with obstructed pins released, pinned particles may be pushed.
    int max_retries = 3;
    /// Strain that pushing apart may add. The solve continues if pushing apart adds more than this, or more energy than
    /// Energy::doubtful_gain. After the last continuation, only added energy rejects the step. Larger: single frames
    /// show strain of 0.1 and more.
    double added_strain = 0.05;
    /// Energy gain, relative to the kinetic and elastic energy at the start of the step, above which an unfinished
    /// solve starts anew with fixed normal forces.
    double diverged_energy_ratio = 3;
  } repair;

  /// Pinned particles that an obstacle or other cloth keeps from their targets: they lag
  /// (src/physics/simulation/yielding_pins.cpp).
  struct Pins {
    /// Maximum speed of a returning particle relative to its target [m/s].
    double return_velocity = 1;
    /// Maximum force on a lagging particle of mass m: max(`acceleration` m, W / n, min(W / k, `most_acceleration` m)).
    /// W: `cloth_weight_factor` times the weight of the cloth; n, k: number of all and of lagging particles of the pin.
    double acceleration = 2000;  // [m/s²]
    double cloth_weight_factor = 3;
    double most_acceleration = 20000;  // [m/s²]
  } pins;

  /// Rigid bodies that move by forces (forces/rigidity.hpp).
  struct Bodies {
    /// Squared angular frequency of their stretching [1/`time.step`²]. Smaller: an impact of 1 m/s compresses them by
    /// more than 1e-6 m; larger: rounding in single precision.
    double rigidity = 1e4;
    /// Contact thickness [m], at most `thickness_of_size` times the smallest component of RigidFrame::deviations().
    /// Smaller: bodies at rest on each other rattle; larger: gaps are visible.
    double thickness = 5e-4;
    double thickness_of_size = 0.1;
  } bodies;

  /// Energy without a source, relative to EnergyBound::energy_in_play(): kinetic and elastic energy at the start, plus
  /// the ranges that the potential energy and the work of pins have covered so far.
  struct Energy {
    /// `failing_gain`: gain above which a run fails (if cloth can touch something, only with the midpoint rule, as
    /// the others damp contact). Also the work of the residual above which a run warns. `doubtful_gain`: gain above
    /// which a run warns. Also the energy that pushing apart may add, relative to that at the start of the step.
    double failing_gain = 0.3;
    double doubtful_gain = 0.1;
    /// Energy that is never an error [J/kg]: enough to lift cloth by 1 cm.
    double negligible = 0.1;
  } energy;
};

extern const Numerics numerics;

}  // namespace weft
