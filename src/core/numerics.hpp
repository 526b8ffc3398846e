// The tuned constants of a time step. Constants that belong to one algorithm (untangling, stretch limits, single
// precision) are in the file of that algorithm.
#pragma once

namespace weft {

/// Constants tuned on the shipped scenes and those of tests/bench/scenes: cloth of 0.05 to 1 kg/m²,
/// particle spacings of 1 cm to 1 m, steps of 1 to 40 ms. "Larger: X" means that a larger value was
/// measured to cause X; "Smaller:", "0:" and the like have the same meaning. Members without a unit
/// are ratios or counts. `tests/tools/change_numerics.sh` shows which tests fail if a member
/// changes.
struct Numerics {
  /// The linear solver (src/physics/solver).
  struct Linear {
    /// A particle of a cloth is stiff if the trace of its 3×3 diagonal block of the matrix exceeds
    /// this value times the sum of `LinearSystem::norm_weights` over the cloth. If any particle is
    /// stiff, the multigrid levels correct each aggregate as a whole; otherwise, they interpolate
    /// between aggregates (Preconditioner). Larger: systems with slender cells or a viscosity of
    /// 1e4 N·s/m are not solved. Smaller: soft cloth takes twice as many iterations.
    double stiff_particle = 1e3;
    /// After n iterations, the error is estimated from the last max(`min_error_window`, n /
    /// `error_window_divisor`) iterations, at most n. With fewer iterations, solves end where the
    /// error only stagnates, and cloth with a viscosity of 1e4 N·s/m gains energy.
    int min_error_window = 3;
    int error_window_divisor = 5;
    /// Maximum number n of cloth aggregates on the coarsest multigrid level. If there are more than
    /// n cloths, this level has one aggregate per cloth. The dense Cholesky factorisation of n
    /// aggregates takes 4.5 n³ multiplications.
    int coarsest_aggregates = 70;
  } linear;

  /// Newton's method (src/physics/integrator).
  struct Newton {
    /// Allowed error of a linear solve, relative to the allowed error of Newton's method. If the
    /// Newton error of a diagonal block (a cloth or rigid body) is at most this fraction of the
    /// allowed error, the next linear solve omits this block (but see `slow_after`). 1: fewer
    /// iterations, but more strain.
    double linear_fraction = 0.8;
    /// Factor on `linear_fraction` and on `solver.linear_tolerance` for the midpoint rule, which damps nothing. Larger:
    /// flat sheets fold in free fall.
    double midpoint_tightening = 0.1;
    /// A line search ends if the magnitude of the slope (residual · direction) is at most
    /// `slope_left` times its initial magnitude, or after `line_trials` evaluations. Smaller
    /// `slope_left`: more evaluations. Larger: more Newton iterations.
    double slope_left = 0.5;
    int line_trials = 6;
    /// Number of Newton iterations after which the first solve of a step pauses, so that contacts
    /// on the new trajectory are found early.
    int check_after = 4;
    /// Number of Newton iterations after which a solve counts as slow. In a slow solve, the normal
    /// forces that limit friction stay fixed, and the bound of the velocity error that the solver
    /// may leave is at least `solver.newton_tolerance` times min_visible_velocity(). With implicit Euler,
    /// it is also at least `solver.newton_tolerance` times `velocity_ratio` times the truncation
    /// error of the velocity in this step. From half of this number on, each linear
    /// solve includes all diagonal blocks. Larger: friction and normal forces, or cloths that press
    /// on each other, oscillate. `slow_after` is also the maximum number of times that the solve of
    /// a step continues after cloth was pushed apart. 0: tests/bench/scenes/ring.toml takes four
    /// times the steps.
    int slow_after = 20;
    double velocity_ratio = 0.5;
    /// Time for which a velocity error is assumed to displace cloth [s]. Smaller: most of the error
    /// of a run comes from the solver. Larger: more iterations.
    double error_duration = 0.15;
    /// Visibility thresholds: smaller errors of acceleration [m/s²] and velocity [m/s] are not visible. As bounds of
    /// solver errors, both are multiplied by `solver.newton_tolerance`.
    double min_visible_acceleration = 0.01;
    double min_visible_velocity() const { return min_visible_acceleration * error_duration; }
    /// A cloth or rigid body counts as about to slide if its friction, summed over its contacts,
    /// exceeds this fraction of the maximum.
    double about_to_slide = 0.9;
    /// Newton's method reuses the matrix rows of a cloth until one of its particles has moved
    /// farther than this since the rows were assembled; in units of the smallest particle spacing
    /// of all cloths. Larger: more iterations.
    double stale_motion = 0.005;
  } newton;

  /// Step sizes from `time.tolerance` (src/physics/integrator/step_control.cpp), and after rejections.
  struct Steps {
    /// Local error that the step control aims at, relative to `time.tolerance`. Nearer to 1: more
    /// steps are rejected.
    double target_error_ratio = 0.7;
    /// Minimum and maximum ratio of the length of a step to that of the step before. After a
    /// rejection, the maximum is 1. Larger `largest_factor`: BDF2 amplifies earlier errors.
    double least_factor = 0.2;
    double largest_factor = 1.5;
    /// Minimum length of a step that the step control chooses because of its local error [s]. If a
    /// step is not solved, it is halved even below this length; but if a step that is already
    /// shorter is not solved, the run ends. Without `time.tolerance`, this value has no effect.
    double min_step = 1e-5;
    /// Cloth counts as at rest only if no particle is faster than this [m/s]; see
    /// StepLoop::may_merge_steps().
    double rest_velocity = 0.02;
  } steps;

  /// Contacts (src/physics/collision).
  struct Contact {
    /// Ratio of the detection distance to the largest contact thickness. Smaller: contacts are
    /// found late in a step.
    double detection_ratio = 1.5;
    /// Verlet margin m of near pairs, in detection distances: the search reuses its list of near
    /// pairs until a vertex has moved farther than this. Larger: longer lists. Smaller: more
    /// searches. Other bounds follow from m, also in detection distances:
    /// - 2 m: Verlet margin of candidate pairs. If a vertex moves this far along an axis in a step,
    ///   candidate pairs have no margin and are listed for this step alone,
    /// - m / 2: `search.coherence` keeps closest points until a vertex has moved farther than this,
    /// - m: if, in a step, the arc of a vertex of a turning obstacle deviates from its chord by more than this, the
    ///   step is halved,
    /// - m: if no obstacle moves farther than this in a step, the step loop assumes that cloth
    ///   between obstacles would have no more space in shorter steps.
    double verlet_margin = 0.25;
    /// Maximum contact thickness of a cloth other than a rope, in units of its smallest particle
    /// spacing. Larger: a sheared sheet collides with itself.
    double thickness_of_spacing = 0.25;
    /// Minimum contact stiffness, relative to M/h². h: `time.step`. M: weighted mean mass of the
    /// contact's particles. If cloth or a rigid body touches a rigid body that forces move, only the
    /// particles of the lighter side count. Thus, in a step of implicit Euler of length h, a contact
    /// leaves at most a hundredth of the penetration that the motion without contact would cause.
    double inertial_stiffness = 100;
    /// Factor `stiffening` of the normal force k d (1 + stiffening (d/r)⁴) at a depth d up to the
    /// full activation distance r, with stiffness k. At larger depths, the force is linear. 10:
    /// tips penetrate; 1000: more iterations.
    double stiffening = 100;
    /// Width w of the ramps along which the stiffness of a near pair falls to zero (stiffness_fraction()). 0: contacts
    /// switch on and off. Larger: only separating planes keep crossing creases apart. The stiffness falls
    /// - while the contact direction leaves the wedge of normals of an edge or vertex: while the sine of its angle to
    ///   the wedge (`Proximity::outside_wedge`, negative inside) grows from 0 to w,
    /// - for edge pairs with cloth, while the sum of the sines by which the direction lies inside of both wedges falls
    ///   from 2 w to w / 2, because the surfaces become flat at the edges,
    /// - for edge pairs with cloth, while the closest point moves from the fraction w of an edge to its end.
    double ramp_width = 0.1;
    /// Value of the sum in the second item at which the stiffness is zero: below it, surfaces count as flat at an edge.
    double flat_fold() const { return 0.5 * ramp_width; }
    /// Slip velocity below which a contact sticks: friction then grows with the slip [m/s]. For
    /// contacts that are springs, this velocity is at least `stick_spacings` [1/s] times the
    /// smallest particle spacing of all cloths. Larger: cloth creeps down slopes. Smaller: a
    /// stiffer system.
    double stick_velocity = 2e-4;
    double stick_spacings = 0.002;
    /// Slip velocity from which the friction coefficient is that of sliding, in units of the stick
    /// velocity.
    double slide_velocity = 5;
    /// Closing velocity [m/s] from which BDF2 treats a contact fully as an impact. At smaller
    /// closing velocities, the fraction treated as an impact is proportional to the velocity.
    /// Larger: impacts in short steps rebound.
    double impact_velocity = 0.05;
    /// If the slip of a sliding contact reverses, the contact sticks again, unless it has already
    /// begun to slide this many times in the step. 0: tests/bench/scenes/ribbons_in_half_pipe.toml
    /// takes 1.4 times the iterations. 20: friction with a coefficient of 10 does not settle.
    int max_resticks = 2;
    /// Time in which the activation distance of a contact may grow from 0 to its full value [s]: in
    /// a step of length h, it is at most the gap at the start of the step plus the fraction h /
    /// `range_growth_time` of its full value. 0: in steps of 1 ms or less, surfaces that are
    /// already close when a contact appears fly apart and gain energy.
    double range_growth_time = 5e-3;
    /// Factor on the stiffness of a contact that pushes pinched cloth out, if an obstacle blocks
    /// the way out.
    double blocked_exit_factor = 0.05;
  } contact;

  /// Separating planes, which guarantee that nothing intersects (src/physics/collision/response).
  struct Separation {
    /// Minimum gap between two triangles along the normal of their separating plane, at the end of a step [m]. Smaller:
    /// rounding errors decide. Larger: thin cloth fails.
    double least_gap = 1e-6;
    /// Pushing apart restores a gap of max(2 `least_gap`, min(`restored_gap`, half of the gap at the start)) [m].
    double restored_gap = 2e-4;
    /// Maximum number of rounds of pushing apart. If pairs still fail, their particles move back:
    /// by half of their motion in up to `max_rounds` / 2 further rounds, then to the start of the step
    /// in up to `max_rounds` rounds; then all particles move back. Smaller: particles move back farther
    /// than necessary.
    int max_rounds = 24;
  } separation;

  /// Velocity constraints of Etzmuß et al. (2001), if `contact.response` selects them: a contact of a particle with an
  /// obstacle is a wall that the particle may not pass (VelocityConstraints).
  struct Walls {
    /// If a particle is closer to an obstacle than the minimum distance, a step restores this fraction of the missing
    /// distance (γ in Eq. 4 of Etzmuß et al.).
    double correction = 0.2;
    /// Minimum sine of the angle between the normal of a wall and the span of the normals of the walls before it. If
    /// the sine is smaller, the wall adds no constraint.
    double min_independent_sine = 0.05;
    /// `max_constraint_changes`: number of changes of a particle's constraints in a step; further changes do not cause
    /// another solve. `max_solves`: maximum number of solves in a step. `max_walls`: maximum
    /// number of walls per particle.
    int max_constraint_changes = 3;
    int max_solves = 6;
    int max_walls = 8;
    /// A change of constraints needs no further solve if it changes the constraint force per mass
    /// by less than `negligible_acceleration` [m/s²], or friction by less than `negligible_change`
    /// of its limit.
    double negligible_acceleration = 0.5;
    double negligible_change = 0.2;
  } walls;

  /// Repairs of a step (src/physics/simulation/step_loop.cpp).
  struct Repair {
    /// Number of tries after which the step loop accepts a compromise:
    /// - after this many rejections of a step, cloth may count as pinched if obstacles move little,
    ///   and pushing apart may add much energy,
    /// - after this many halvings of a trajectory, the search for its separating planes ends (0: a
    ///   tenth more iterations of the solver),
    /// - after a step has been tried this many times, each time with more obstructed pins released, pushing apart may
    ///   move pinned particles.
    int max_retries = 3;
    /// If pushing apart adds more strain than this, or more energy than Energy::doubtful_gain, the
    /// solve continues from the pushed positions. After the last such continuation, only added
    /// energy can reject the step. Larger: single frames show strain of 0.1 and more.
    double added_strain = 0.05;
    /// If the first solve of a step has added more energy than this when it pauses (`check_after`),
    /// relative to the kinetic and elastic energy at the start of the step, the solve begins again
    /// with fixed normal forces.
    double diverged_energy_ratio = 3;
  } repair;

  /// Pinned particles that an obstacle or other cloth keeps from their targets. Such particles lag: a force pulls them
  /// back (src/physics/simulation/yielding_pins.cpp).
  struct Pins {
    /// Maximum speed, relative to its target, with which a lagging particle is pulled back [m/s].
    double return_velocity = 1;
    /// Maximum force on a lagging particle of mass m: max(`acceleration` m, W / n, min(W / k,
    /// `most_acceleration` m)). W: `cloth_weight_factor` times the weight of the cloth under the
    /// largest gravity of the run. The pin has n particles, k of which lag.
    double acceleration = 2000;  // [m/s²]
    double cloth_weight_factor = 3;
    double most_acceleration = 20000;  // [m/s²]
  } pins;

  /// Rigid bodies that move by forces (forces/rigidity.hpp).
  struct Bodies {
    /// Squared angular frequency of the elastic stretch of the body, in 1/`time.step`². Smaller: an
    /// impact of 1 m/s compresses the body by more than 1e-6 m. Larger: rounding errors in single
    /// precision.
    double rigidity = 1e4;
    /// Contact thickness [m]; reduced to `thickness_of_size` times the smallest component of RigidFrame::deviations()
    /// if that is smaller. Smaller: bodies at rest on each other rattle. Larger: gaps are visible.
    double thickness = 5e-4;
    double thickness_of_size = 0.1;
  } bodies;

  /// Bounds of energy without a source. Gains in a run are relative to EnergyBound::energy_in_play(): the kinetic and
  /// elastic energy at the start, plus the ranges that the potential energy, of gravity and enclosed air, and the work
  /// of pins have covered so far.
  struct Energy {
    /// If the gain exceeds this value, the run fails. Exception: if cloth can touch something and
    /// the method is not the midpoint rule, the run only warns, because the method damps contacts.
    /// The run also warns if the work of the solver's residual exceeds this value, relative to the
    /// energy in play plus the largest kinetic and elastic energy so far.
    double failing_gain = 0.3;
    /// If the gain exceeds this value, the run warns. Two other bounds have this value, too: the
    /// energy that pushing apart may add, relative to the kinetic and elastic energy at the start
    /// of the step, and the work of the solver's residual on a diagonal block in a step, relative
    /// to the kinetic energy of the block.
    double doubtful_gain = 0.1;
    /// Energy per mass that is added to the bounds of gains and of the residual's work [J/kg]: enough
    /// to lift cloth by 1 cm.
    double negligible = 0.1;
  } energy;
};

extern const Numerics numerics;

}  // namespace weft
