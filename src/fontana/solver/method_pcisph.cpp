// PCISPH: Solenthaler and Pajarola 2009, the thesis's future work. Predict positions, correct the pressure by what the
// density would be, until it is within the tolerance.
#include <algorithm>
#include <cmath>

#include "solver/constants.h"
#include "solver/diagnostics.h"
#include "solver/methods.h"
#include "solver/operators.h"

namespace fontana {
namespace {

constexpr std::uint32_t k_least_iterations = 3;

class Pcisph : public Method {
 public:
    explicit Pcisph(Backend& backend) : backend_(backend), operators_(backend) {}

    void advance(Substep& s) override {
        begin(s);
        s.choose_time_step();
        operators_.add_forces(s);
        operators_.predict(s);
        s.place_colliders();
        solve(s);
        operators_.compute_gradient(s, *u_);
        operators_.push(s);
        operators_.finish(s, *u_);
        may_be_crowded_ = true;
    }

    bool may_be_crowded() const override { return may_be_crowded_; }

    void end_frame(Substep& s) override {
        begin(s);
        operators_.refresh(s, *u_);
        may_be_crowded_ = false;
    }

 private:
    void begin(Substep& s) {
        reserve(s.particles.capacity());  // before anything moves: a frame that lacked memory can be tried again
        operators_.begin(s);
        operators_.move_apart(s, {*u_, *predicted_, s.particles.spare_words(), *sums_});
    }

    void solve(Substep& s) {
        const std::size_t count = s.particles.count();
        const double tolerance = density_error_tolerance(s.parameters);
        const auto delta = static_cast<float>(pcisph_delta(s.parameters));
        backend_.launch(Kernel::clear_words, count, {static_cast<std::uint32_t>(count), *u_});
        s.report.converged = false;
        for (std::uint32_t k = 1; k <= static_cast<std::uint32_t>(s.parameters.solver_max_iterations); ++k) {
            operators_.compute_gradient(s, *u_);
            backend_.launch(
                Kernel::predict_position, count,
                {s.constants, s.particles.position(), s.particles.velocity(), operators_.gradient(), *predicted_});
            backend_.launch(
                Kernel::correct_pressure, count,
                {s.constants, delta, s.particles.position(), *predicted_, operators_.list().start(),
                 operators_.list().list(), s.colliders.buffer(), operators_.factor(), *u_, s.particles.spare_words()});
            s.report.iterations = k;
            if (k >= k_least_iterations && mean_of(backend_, s.particles.spare_words(), count, *sums_) <= tolerance) {
                s.report.converged = true;
                return;
            }
        }
    }

    void reserve(std::size_t particle_capacity) {
        if (predicted_ && predicted_->bytes() >= particle_capacity * 16) return;
        sums_ = backend_.allocate("sums", k_most_lanes * 4);
        u_ = backend_.allocate("pressure", particle_capacity * 4);
        predicted_ =
            backend_.allocate("predicted position", particle_capacity * 16);  // the last: all of them are there
    }

    Backend& backend_;
    Operators operators_;
    bool may_be_crowded_ = true;
    std::unique_ptr<Buffer> sums_, u_, predicted_;
};

}  // namespace

std::unique_ptr<Method> make_pcisph(Backend& backend) { return std::make_unique<Pcisph>(backend); }

}  // namespace fontana
