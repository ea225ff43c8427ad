#include "continuum/stiff_integrator.hpp"

#include "core/base/check.hpp"
#include "core/base/error.hpp"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

namespace thalweg::continuum {

namespace {

constexpr long most_steps = 200000;  // of one interval
// Residual of Newton's method relative to the error of a step. With CVODE's default of 0.1, the residual in stiff
// unknowns counts as an error of the step, which then gets ever shorter.
constexpr double newton_share = 0.01;
constexpr int highest_order = 2;  // A-stable; beyond it, fast oscillations of drag and friction would grow

// A C object of CVODE with its deleter.
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, void (*)(Handle)>;

template <typename Handle>
Owned<Handle> owned(Handle handle, void (*free)(Handle)) {
  if (handle == nullptr) throw RunError("SUNDIALS could not be set up: there is too little memory.");
  return {handle, free};
}

void require(int flag, const char* what) {
  if (flag < 0) throw RunError(fmt::format("SUNDIALS could not be set up: {} returned {}.", what, flag));
}

SUNContext new_context() {
  SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
  require(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
#else
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
#endif
  return context;
}

void free_context(SUNContext context) { SUNContext_Free(&context); }
void free_solver(SUNLinearSolver solver) { SUNLinSolFree(solver); }
void free_integrator(void* cvode) { CVodeFree(&cvode); }

// Errors are told by whoever looks at what CVODE returns; it prints nothing itself. From version 7 on, its one warning,
// of steps that do not change the time, goes past the error handlers.
#if SUNDIALS_VERSION_MAJOR >= 7
void keep_quiet(void* cvode, SUNContext context) {
  require(SUNContext_ClearErrHandlers(context), "SUNContext_ClearErrHandlers");
  require(CVodeSetMaxHnilWarns(cvode, -1), "CVodeSetMaxHnilWarns");
}
#else
void ignore_error(int, const char*, const char*, char*, void*) {}
void keep_quiet(void* cvode, SUNContext) {
  require(CVodeSetErrHandlerFn(cvode, ignore_error, nullptr), "CVodeSetErrHandlerFn");
}
#endif

}  // namespace

struct StiffIntegrator::Memory {
  Memory(int half_bandwidth, std::vector<Tolerance> wanted, Rates rates_of)
      : size(static_cast<int>(wanted.size())),
        tolerances(std::move(wanted)),
        rates(std::move(rates_of)),
        context(owned(new_context(), free_context)),
        unknowns(owned(N_VNew_Serial(size, context.get()), N_VDestroy)),
        matrix(owned(SUNBandMatrix(size, half_bandwidth, half_bandwidth, context.get()), SUNMatDestroy)),
        solver(owned(SUNLinSol_Band(unknowns.get(), matrix.get(), context.get()), free_solver)),
        cvode(owned(CVodeCreate(CV_BDF, context.get()), free_integrator)) {
    keep_quiet(cvode.get(), context.get());
    require(CVodeInit(cvode.get(), evaluate, 0.0, unknowns.get()), "CVodeInit");
    require(CVodeWFtolerances(cvode.get(), weigh), "CVodeWFtolerances");
    require(CVodeSetUserData(cvode.get(), this), "CVodeSetUserData");
    require(CVodeSetLinearSolver(cvode.get(), solver.get(), matrix.get()), "CVodeSetLinearSolver");
    require(CVodeSetMaxOrd(cvode.get(), highest_order), "CVodeSetMaxOrd");
    require(CVodeSetNonlinConvCoef(cvode.get(), newton_share), "CVodeSetNonlinConvCoef");
    require(CVodeSetMaxNumSteps(cvode.get(), most_steps), "CVodeSetMaxNumSteps");
  }

  // A value that is not finite makes CVODE try a shorter step.
  static int evaluate(sunrealtype, N_Vector unknowns, N_Vector rates, void* self) {
    const auto* memory = static_cast<const Memory*>(self);
    const std::span<double> found(N_VGetArrayPointer(rates), static_cast<std::size_t>(memory->size));
    memory->rates({N_VGetArrayPointer(unknowns), static_cast<std::size_t>(memory->size)}, found);
    return std::all_of(found.begin(), found.end(), [](double rate) { return std::isfinite(rate); }) ? 0 : 1;
  }

  static int weigh(N_Vector unknowns, N_Vector weights, void* self) {
    const std::vector<Tolerance>& tolerances = static_cast<const Memory*>(self)->tolerances;
    const double* y = N_VGetArrayPointer(unknowns);
    double* weight = N_VGetArrayPointer(weights);
    for (std::size_t i = 0; i < tolerances.size(); ++i)
      weight[i] = 1.0 / (tolerances[i].relative * std::abs(y[i]) + tolerances[i].absolute);
    return 0;
  }

  int size;
  std::vector<Tolerance> tolerances;
  Rates rates;
  Owned<SUNContext> context;
  Owned<N_Vector> unknowns;
  Owned<SUNMatrix> matrix;
  Owned<SUNLinearSolver> solver;
  Owned<void*> cvode;
};

StiffIntegrator::StiffIntegrator(int half_bandwidth, std::vector<Tolerance> tolerances, Rates rates)
    : memory_(std::make_unique<Memory>(half_bandwidth, std::move(tolerances), std::move(rates))) {}

StiffIntegrator::~StiffIntegrator() = default;

void StiffIntegrator::advance(std::span<double> unknowns, double duration) {
  CHECK(unknowns.size() == static_cast<std::size_t>(memory_->size));
  CHECK(duration > 0.0);
  double* own = N_VGetArrayPointer(memory_->unknowns.get());
  std::copy(unknowns.begin(), unknowns.end(), own);
  void* cvode = memory_->cvode.get();
  require(CVodeReInit(cvode, 0.0, memory_->unknowns.get()), "CVodeReInit");
  require(CVodeSetStopTime(cvode, duration), "CVodeSetStopTime");
  double reached = 0.0;
  const int flag = CVode(cvode, duration, memory_->unknowns.get(), &reached, CV_NORMAL);
  long taken = 0;
  CVodeGetNumSteps(cvode, &taken);
  steps_ += taken;
  if (flag < 0) {
    char* name = CVodeGetReturnFlagName(flag);
    const std::string reason = name;
    std::free(name);
    throw RunError(
        fmt::format("The equations of the column cannot be integrated further: CVODE stopped with {} after {} steps, "
                    "{:.3g} s into an interval of {:.3g} s.",
                    reason, taken, reached, duration));
  }
  std::copy(own, own + memory_->size, unknowns.begin());
}

}  // namespace thalweg::continuum
