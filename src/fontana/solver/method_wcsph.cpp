// Weakly compressible SPH: Tait's equation and a symmetric pressure force (Becker and Teschner 2007), with the spline
// for density and gradient and walls that count.
#include "solver/methods.h"
#include "solver/operators.h"

namespace fontana {
namespace {

class Wcsph : public Method {
 public:
    explicit Wcsph(Backend& backend) : backend_(backend), operators_(backend) {}

    void advance(Substep& s) override {
        reserve(s.particles.capacity());  // before anything moves: a frame that lacked memory can be tried again
        operators_.begin(s);
        s.choose_time_step();
        operators_.add_forces(s);
        operators_.predict(s);
        backend_.launch(Kernel::tait_pressure, s.particles.count(), {s.constants, s.particles.density(), *u_});
        operators_.compute_gradient(s, *u_);
        operators_.push(s);
        operators_.finish(s, *u_);
    }

 private:
    void reserve(std::size_t particle_capacity) {
        if (!u_ || u_->bytes() < particle_capacity * 4) u_ = backend_.allocate("pressure", particle_capacity * 4);
    }

    Backend& backend_;
    Operators operators_;
    std::unique_ptr<Buffer> u_;
};

}  // namespace

std::unique_ptr<Method> make_wcsph(Backend& backend) { return std::make_unique<Wcsph>(backend); }

}  // namespace fontana
