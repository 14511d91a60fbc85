// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/morph.h"

#include "engine/fit/bands.h"
#include "engine/scene/same_faces.h"
#include "eval/fit/decompose.h"
#include "far_ext/error.h"
#include "far_ext/option_checks.h"

namespace limn::engine {

void MorphOptions::Check() const {
    for (MorphStep const& step : steps) {
        RequireRange("rate", step.rate, 0.0, 1.0);
        RequireRange("detail", step.detail, 0, kMaxBands);
    }
}

Morph::Morph(Model const& from, Model const& to, MorphOptions const& options)
    : _to(to),
      _options(options),
      _operator(eval::LimitApplication::Build(to.GetRefiner(), options.rule, options.evaluator)),
      _positions(from.GetPositions()) {
    options.Check();
    RequireSameFaces(from, to, "a morph");
    for (MorphStep const& step : options.steps) _keptAtEnd *= step.rate;
    if (options.endsExactly && !(_keptAtEnd < 1.0))
        throw Error(ErrorCode::BadOption, "a morph whose steps keep all has no exact end");
}

void Morph::TakeStep(size_t step, std::vector<double>& positions) const {
    auto const [detail, rate] = _options.steps[step];
    eval::MorphStep(_operator, 3, detail, rate, _to.GetPositions(), positions);
}

/// Goes all the way beforehand, to know what is left at its end.
void Morph::FindRest(Job& job) {
    _rest = _positions;
    for (size_t step = 0; step < _options.steps.size(); ++step) {
        job.CheckStopped();
        TakeStep(step, _rest);
    }
    for (size_t i = 0; i < _rest.size(); ++i) _rest[i] -= _to.GetPositions()[i];
}

std::vector<double> const& Morph::MakeNext(Job& job) {
    if (_numMade == _options.steps.size())
        throw Error(ErrorCode::BadOption, "a morph has as many frames as steps; all are made");
    job.CheckStopped();
    job.Start("morphing");
    if (_options.endsExactly && _numMade == 0) FindRest(job);
    _kept *= _options.steps[_numMade].rate;
    TakeStep(_numMade++, _positions);
    if (!_options.endsExactly) return _positions;
    if (_numMade == _options.steps.size()) return _to.GetPositions();

    double const share = (1.0 - _kept) / (1.0 - _keptAtEnd);
    _frame = _positions;
    for (size_t i = 0; i < _frame.size(); ++i) _frame[i] -= share * _rest[i];
    return _frame;
}

}  // namespace limn::engine
