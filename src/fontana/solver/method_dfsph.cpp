// DFSPH: Bender and Koschier 2017. Velocities are made free of divergence, forces act, and the pressure that keeps the
// density is found by the solve of kernels/pressure_solve.h, warm-started with the whole of the last one.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/pressure_solve.h"
#include "solver/coarse_correction.h"
#include "solver/constants.h"
#include "solver/methods.h"
#include "solver/operators.h"

namespace fontana {
namespace {

constexpr float k_jacobi_relaxation = 0.5f;  // safe up to 0.7: the largest eigenvalue of D^-1 K is below 2.85
constexpr float k_anderson_relaxation = 0.65f;
constexpr float k_coarse_relaxation = 0.5f;
constexpr float k_worse = 4.0f;  // times the first residual: a coarse correction that leads there does not help
constexpr std::uint32_t k_least_iterations = 2;
// Lanes that add up the sums: one for so many particles, up to what fills a large GPU; and what they are folded into.
constexpr std::uint32_t k_particles_a_lane = 64, k_lanes = 16384, k_folded_lanes = 128;
constexpr std::size_t k_depth = 2;

// As in kernels/pressure_solve.h.
struct SolveState {
    float residual, history, gamma_0, gamma_1, done, iterations;
};
static_assert(sizeof(SolveState) == SOLVE_STATE_SIZE * sizeof(float));

class Dfsph : public Method {
 public:
    explicit Dfsph(Backend& backend) : backend_(backend), operators_(backend), coarse_(backend) {}

    void advance(Substep& s) override {
        begin(s);
        s.choose_time_step();
        operators_.add_forces(s);
        residual_ = &s.particles.spare_words();
        remove_divergence(s);
        operators_.predict(s);
        solve_density(s);
        operators_.compute_gradient(s, *pressure_);
        operators_.push(s);
        operators_.finish(s, *pressure_);
        may_be_crowded_ = !is_calm(s);
    }

    bool may_be_crowded() const override { return may_be_crowded_; }

    void end_frame(Substep& s) override {
        begin(s);
        operators_.refresh(s, u(1));
        may_be_crowded_ = false;
    }

 private:
    void begin(Substep& s) {
        reserve(s);
        operators_.begin(s);
        operators_.move_apart(s, {u(1), u(2), u(3), *state_});
    }

    // Water whose fastest particle keeps within a fifth of a spacing in a step as long as they come.
    static bool is_calm(const Substep& s) {
        constexpr double k_calm = 0.2;
        const double longest =
            std::max(s.report.step.dt, time_step_limits(s.parameters, s.report.speed, 0.0).convergence);
        return s.report.speed * longest < k_calm * sampling_distance(s.parameters);
    }

    // The density error to stop at. What a solve leaves over, the next one takes out at once: a pool would hum with it,
    // at speeds that show in calm water only. There it is a fifth of the error asked for, or two hundredths of a
    // percent. Jacobi alone, the reference, would take too long for it.
    static double tolerance(const Substep& s) {
        constexpr double k_part = 0.2, k_quiet = 2e-4;
        const double asked = density_error_tolerance(s.parameters);
        if (s.parameters.solver_pressure_solver == "jacobi" || !is_calm(s)) return asked;
        return std::max(k_part * asked, std::min(k_quiet, asked));
    }

    // Of the two-sided residual, 1/s^2. It counts too much pressure as well as too little, and only the latter is
    // density error: a tenth more than the error asked for still leaves less than that
    // (test_the_density_error_is_the_quality).
    static double allowed_residual(const Substep& s) {
        return 1.1 * tolerance(s) / (s.report.step.dt * s.report.step.dt);
    }

    // Errors of the pressure over long distances are seen where the water is calm. They shoot off droplets where
    // something strikes and particles crowd. And a loose solve leaves so much of them that they would add up, step
    // after step, until a tall tank blew up.
    static bool long_waves_matter(const Substep& s) {
        constexpr double k_crowded = 0.05, k_loose = 0.002;
        return is_calm(s) || s.report.density_error_max > k_crowded || density_error_tolerance(s.parameters) > k_loose;
    }

    void remove_divergence(Substep& s) {
        backend_.launch(
            Kernel::divergence_step, s.particles.count(),
            {s.constants, k_anderson_relaxation, s.particles.density(), operators_.rate(), operators_.factor(), u(1)});
        operators_.compute_gradient(s, u(1));
        operators_.push(s);
    }

    void solve_density(Substep& s) {
        const std::size_t count = s.particles.count();
        excess_ = &operators_.rate();  // which was for the divergence
        backend_.launch(Kernel::density_excess, count,
                        {s.constants, s.particles.density(), operators_.wall_rate(), *excess_});
        operators_.load_warm_start(s, u(1));
        compute_residual(s, 1);
        const auto most = static_cast<std::uint32_t>(s.parameters.solver_max_iterations);
        with_coarse_ = may_be_coarse(s) && long_waves_matter(s);
        const bool may_give_up = may_be_coarse(s) && !with_coarse_;
        if (with_coarse_) coarse_.prepare(s, operators_, *residual_, u(1), *workspace_);
        SolveState state = iterate_until_done(s, most, may_give_up);
        s.report.iterations = static_cast<std::uint32_t>(state.iterations);
        if (may_give_up && state.done == 0.0f && s.report.iterations < most) {
            if (pressure_ != &u(1)) backend_.copy(*pressure_, u(1), count * 4);
            with_coarse_ = true;
            compute_residual(s, 1);
            coarse_.prepare(s, operators_, *residual_, u(1), *workspace_);
            state = iterate_until_done(s, most - s.report.iterations, false);
            s.report.iterations += static_cast<std::uint32_t>(state.iterations);
        }
        s.report.converged = state.done > 0.0f;
    }

    // Without the grid there are no cells to merge.
    static bool may_be_coarse(const Substep& s) {
        return s.parameters.solver_pressure_solver == "multilevel" && s.constants.use_grid;
    }

    // From u(1) and its residual to pressure_. The matrices of the coarse levels cost as much as two iterations, and
    // most solves in a splash are done soon; so those that may give up do where eight more would not suffice at the
    // pace they have.
    SolveState iterate_until_done(Substep& s, std::uint32_t most, bool may_give_up) {
        // A GPU would rather run an iteration too many, which changes nothing, than wait for an answer after each.
        const std::uint32_t poll = backend_.device().is_gpu ? 2 : 1;
        SolveState state{};
        float first_residual = std::numeric_limits<float>::infinity(), residual_before = first_residual;
        for (std::uint32_t k = 1; k <= most; ++k) {
            if (k > 1) compute_residual(s, k);
            iterate(s, k);
            pressure_ = &u(k + 1);
            if (k % poll != 0 && k != most) continue;
            backend_.read(*state_, &state, sizeof state);
            if (state.done > 0.0f) break;
            // Decisions fall every second iteration, whenever the host asks: all devices take the same.
            if (k % 2 != 0) continue;
            // A correction that makes it worse is left off for the rest of the solve.
            if (k == 2) first_residual = state.residual;
            if (state.residual > k_worse * first_residual) with_coarse_ = false;
            const double pace = static_cast<double>(state.residual / residual_before);  // of two iterations
            if (may_give_up && k >= 4 && static_cast<double>(state.residual) * std::pow(pace, 4) > allowed_residual(s))
                break;
            residual_before = state.residual;
        }
        return state;
    }

    // Of u(k).
    void compute_residual(Substep& s, std::uint32_t k) {
        operators_.compute_pressed_velocity(s, u(k));
        backend_.launch(Kernel::pressure_residual, s.particles.count(),
                        {s.constants, operators_.gradient(), operators_.list().start(), operators_.list().list(),
                         s.particles.position(), operators_.factor(), *excess_, *residual_});
    }

    void iterate(Substep& s, std::uint32_t k) {
        const std::size_t count = s.particles.count();
        const auto n = static_cast<std::uint32_t>(count);
        const std::uint32_t lanes = std::min(k_lanes, std::max<std::uint32_t>(1, n / k_particles_a_lane));
        const std::uint32_t folded = std::min(k_folded_lanes, lanes), is_first = k == 1 ? 1 : 0;
        const bool accelerated = s.parameters.solver_pressure_solver != "jacobi";
        const float relaxation = with_coarse_  ? k_coarse_relaxation
                                 : accelerated ? k_anderson_relaxation
                                               : k_jacobi_relaxation;
        const auto tolerance = static_cast<float>(allowed_residual(s));

        if (with_coarse_) coarse_.solve(s, *residual_, u(k));
        backend_.launch(Kernel::relax, count,
                        {s.constants, relaxation, std::uint32_t{with_coarse_},
                         with_coarse_ ? coarse_.finest() : CoarseLevel{}, s.particles.position(),
                         s.neighborhood.cell_start(), operators_.factor(), with_coarse_ ? coarse_.weight() : *residual_,
                         *residual_, with_coarse_ ? coarse_.correction() : *residual_, u(k), step(k)});
        backend_.launch(Kernel::anderson_sums, lanes,
                        {n, lanes, operators_.factor(), *residual_, u(k), step(k), step(k + 2), step(k + 1), *sums_});
        backend_.launch(Kernel::fold_sums, folded, {lanes, folded, *sums_, *folded_sums_});
        backend_.launch(Kernel::anderson_coefficients, 1,
                        {s.constants, folded, is_first, std::uint32_t{accelerated}, k_least_iterations, tolerance,
                         *folded_sums_, *state_});
        backend_.launch(Kernel::anderson_update, count,
                        {n, *state_, u(k), u(k + 2), u(k + 1), step(k), step(k + 2), step(k + 1), u(k + 1)});
    }

    // Iterates and steps of iteration k and of the two before it: three places in turn, so k - 1 is k + 2 and k + 1
    // takes the place of k - 2.
    Buffer& u(std::uint32_t k) { return *u_[k % (k_depth + 1)]; }
    Buffer& step(std::uint32_t k) { return *step_[k % (k_depth + 1)]; }

    // All memory before anything moves, so that a substep that lacks some can be tried again. What the coarse
    // correction keeps before the first iteration and what is kept between iterations lie in the same: the former is
    // used up before the latter is written. Only the first u is needed all along.
    void reserve(Substep& s) {
        if (may_be_coarse(s)) coarse_.reserve(s);
        const std::size_t particle_capacity = s.particles.capacity(), bytes = particle_capacity * 4;
        if (state_ && u(1).bytes() >= bytes) return;
        state_.reset();
        constexpr std::size_t alignment = Backend::part_alignment, parts = 2 * (k_depth + 1) - 1;
        const std::size_t part = (bytes + alignment - 1) / alignment * alignment;
        for (std::unique_ptr<Buffer>& former : step_) former.reset();
        for (std::unique_ptr<Buffer>& former : u_) former.reset();
        workspace_.reset();
        const std::size_t products = CoarseCorrection::product_bytes(particle_capacity);
        workspace_ = backend_.allocate("solve", std::max(parts * part, products));
        std::size_t taken = 0;
        for (std::size_t k = 0; k <= k_depth; ++k) {
            step_[k] = backend_.part(*workspace_, "step", part * taken++, bytes);
            u_[k] = k == 1 ? backend_.allocate("pressure", bytes)
                           : backend_.part(*workspace_, "pressure", part * taken++, bytes);
        }
        sums_ = backend_.allocate("sums", k_lanes * SOLVE_SUMS * 4);
        folded_sums_ = backend_.allocate("folded sums", k_folded_lanes * SOLVE_SUMS * 4);
        state_ = backend_.allocate("solve state", sizeof(SolveState));  // the last: it says that all of them are there
    }

    Backend& backend_;
    Operators operators_;
    CoarseCorrection coarse_;
    std::unique_ptr<Buffer> workspace_, u_[k_depth + 1], step_[k_depth + 1];
    bool with_coarse_ = false, may_be_crowded_ = true;
    Buffer* pressure_ = nullptr;                      // the result of the solve, one of u_
    Buffer *residual_ = nullptr, *excess_ = nullptr;  // lent by the particles and the operators
    std::unique_ptr<Buffer> sums_, folded_sums_, state_;
};

}  // namespace

std::unique_ptr<Method> make_dfsph(Backend& backend) { return std::make_unique<Dfsph>(backend); }

}  // namespace fontana
