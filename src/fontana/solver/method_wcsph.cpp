// Weakly compressible SPH: Tait's equation and a symmetric pressure force (Becker and Teschner 2007), with the spline
// for density and gradient and walls that count.
#include "solver/methods.h"
#include "solver/operators.h"

namespace fontana {
namespace {

class Wcsph : public Method {
 public:
    explicit Wcsph(Backend& backend) : operators_(backend) {}

    void advance(Substep& s) override {
        operators_.begin(s);
        s.choose_time_step();
        operators_.add_forces(s);
        operators_.predict(s);
        s.backend.launch(Kernel::tait_pressure, s.particles.count(),
                         {s.constants, s.particles.density(), operators_.u()});
        operators_.compute_gradient(s, operators_.u());
        operators_.push(s);
        operators_.finish(s, operators_.u());
    }

 private:
    Operators operators_;
};

}  // namespace

std::unique_ptr<Method> make_wcsph(Backend& backend) { return std::make_unique<Wcsph>(backend); }

}  // namespace fontana
