// DFSPH: Bender and Koschier 2017. Velocities are made free of divergence, forces act, and the pressure that keeps the
// density is found by the solve of kernels/pressure_solve.h, warm-started with the whole of the last one.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "solver/constants.h"
#include "solver/methods.h"
#include "solver/operators.h"

namespace fontana {
namespace {

constexpr float k_jacobi_relaxation = 0.5f;  // safe up to 0.7: the largest eigenvalue of D^-1 K is below 2.85
constexpr float k_anderson_relaxation = 0.65f;
constexpr std::uint32_t k_least_iterations = 2;
constexpr std::uint32_t k_lanes = 1024, k_folded_lanes = 32;
constexpr std::size_t k_sums = 8, k_state_size = 8;  // floats, as in kernels/pressure_solve.h

struct SolveState {
    float residual, previous, history, gamma_0, gamma_1, done, iterations, largest;
};

class Dfsph : public Method {
 public:
    explicit Dfsph(Backend& backend) : backend_(backend), operators_(backend) {}

    void advance(Substep& s) override {
        operators_.begin(s);
        s.choose_time_step();
        reserve(s.particles.count());
        remove_divergence(s);
        operators_.predict(s);
        solve_density(s);
        operators_.compute_gradient(s, operators_.u());
        operators_.push(s);
        operators_.finish(s, operators_.u());
    }

 private:
    // Where nothing moves fast enough to shorten the step, what is left of the error from one step to the next shows as
    // a hum of a few cm/s; a tighter solve is cheap there and calms it. Below two hundredths of a percent it gains
    // nothing more.
    static double allowed_error(const Substep& s) {
        constexpr double k_calm_share = 0.2, k_calm_enough = 2e-4;
        const double allowed = density_error_tolerance(s.parameters);
        const bool is_calm = std::string_view(s.report.step.limit) == "convergence";
        return is_calm ? std::max(k_calm_share * allowed, std::min(allowed, k_calm_enough)) : allowed;
    }

    void remove_divergence(Substep& s) {
        operators_.compute_rate(s);
        backend_.launch(Kernel::divergence_step, s.particles.count(),
                        {s.constants, k_anderson_relaxation, s.particles.density(), operators_.rate(),
                         operators_.factor(), operators_.u()});
        operators_.compute_gradient(s, operators_.u());
        operators_.push(s);
    }

    void solve_density(Substep& s) {
        const std::size_t count = s.particles.count();
        operators_.compute_rate(s);
        backend_.launch(Kernel::density_target, count, {s.constants, s.particles.density(), operators_.rate()});
        backend_.launch(
            Kernel::load_warm_start, count,
            {static_cast<std::uint32_t>(count), s.particles.velocity(), operators_.factor(), operators_.u()});
        const bool accelerated = s.parameters.solver_pressure_solver == "anderson";
        const auto most = static_cast<std::uint32_t>(s.parameters.solver_max_iterations);
        // A GPU would rather run an iteration too many, which changes nothing, than wait for an answer after each.
        const std::uint32_t poll = backend_.device().is_gpu ? 2 : 1;
        SolveState state{};
        for (std::uint32_t k = 1; k <= most; ++k) {
            iterate(s, k, accelerated);
            if (k < k_least_iterations || (k % poll != 0 && k != most)) continue;
            backend_.read(*state_, &state, sizeof state);
            if (state.done > 0.0f) break;
        }
        s.report.iterations = static_cast<std::uint32_t>(state.iterations);
        s.report.converged = state.done > 0.0f;
    }

    void iterate(Substep& s, std::uint32_t k, bool accelerated) {
        const std::size_t count = s.particles.count();
        const auto n = static_cast<std::uint32_t>(count);
        const std::uint32_t lanes = std::min(k_lanes, std::max<std::uint32_t>(1, n / 4));
        const std::uint32_t folded = std::min(k_folded_lanes, lanes), is_first = k == 1 ? 1 : 0;
        const float relaxation = accelerated ? k_anderson_relaxation : k_jacobi_relaxation;
        const auto tolerance = static_cast<float>(allowed_error(s) / (s.report.step.dt * s.report.step.dt));
        History& older = history_[k % 2];
        History& newer = history_[(k + 1) % 2];

        operators_.compute_gradient(s, operators_.u());
        backend_.launch(
            Kernel::jacobi_step, count,
            {s.constants, relaxation, operators_.gradient(), operators_.list().count(), operators_.list().list(),
             operators_.volume_position(), operators_.factor(), operators_.rate(), operators_.u(), *residual_, *step_});
        backend_.launch(
            Kernel::anderson_sums, lanes,
            {s.constants, lanes, is_first, operators_.volume_position(), operators_.factor(), *residual_,
             operators_.u(), *step_, *u_before_, *step_before_, *older.step, *newer.u, *newer.step, *sums_});
        backend_.launch(Kernel::fold_sums, folded, {lanes, folded, *sums_, *folded_sums_});
        backend_.launch(Kernel::anderson_coefficients, 1,
                        {s.constants, folded, is_first, std::uint32_t{accelerated}, k_least_iterations, tolerance,
                         *folded_sums_, *state_});
        backend_.launch(Kernel::anderson_update, count,
                        {n, *state_, *step_, *older.u, *older.step, *newer.u, *newer.step, operators_.u(), *u_before_,
                         *step_before_});
    }

    void reserve(std::size_t particle_count) {
        if (residual_ && residual_->bytes() >= particle_count * 4) return;
        const std::size_t bytes = (particle_count + particle_count / 4) * 4;
        step_ = backend_.allocate("step", bytes);
        u_before_ = backend_.allocate("pressure before", bytes);
        step_before_ = backend_.allocate("step before", bytes);
        for (History& h : history_) {
            h.u = backend_.allocate("pressure differences", bytes);
            h.step = backend_.allocate("step differences", bytes);
        }
        sums_ = backend_.allocate("sums", k_lanes * k_sums * 4);
        folded_sums_ = backend_.allocate("folded sums", k_folded_lanes * k_sums * 4);
        state_ = backend_.allocate("solve state", k_state_size * 4);
        residual_ = backend_.allocate("residual", bytes);  // the last: it says that all of them are there
    }

    struct History {
        std::unique_ptr<Buffer> u, step;
    };

    Backend& backend_;
    Operators operators_;
    History history_[2];
    std::unique_ptr<Buffer> residual_, step_, u_before_, step_before_, sums_, folded_sums_, state_;
};

}  // namespace

std::unique_ptr<Method> make_dfsph(Backend& backend) { return std::make_unique<Dfsph>(backend); }

}  // namespace fontana
