#include <opensubdiv/osd/cpuEvaluator.h>

#include "eval/interpolate.h"
#include "far_ext/limit_matrix.h"
#include "far_ext/refiner.h"
#include "harness.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
using namespace limn;
using Clock = std::chrono::steady_clock;
static double since(Clock::time_point t){return std::chrono::duration<double>(Clock::now()-t).count();}
int main(int argc,char**argv){
  auto errorApps=[&](char const*name,engine::Scene s){
    test::AddNoise(s,0.1,1);
    auto r=far_ext::CreateRefiner(s.cage);
    eval::Interpolator in(*r);
    std::vector<double> exact(s.positions.size()),P(s.positions.size());
    in.Solve(s.positions,3,exact,{.method=eval::SolveMethod::Direct});
    double lam=in.EstimateSmallestEigenvalue(40), lam2=in.EstimateSmallestEigenvalue(12);
    fmt::print("{:28} n={} lambda {:.4f} ({:.4f}) bound {:.4f}:",name,s.cage.numVertices,lam,lam2,in.GetOperator().GetEigenvalueBound());
    double mean[3]={0,0,0};for(size_t i=0;i<exact.size();++i)mean[i%3]+=exact[i];for(double&m:mean)m/=s.cage.numVertices;
    double norm=0;for(size_t i=0;i<exact.size();++i)norm+=(exact[i]-mean[i%3])*(exact[i]-mean[i%3]);
    for(auto m:{eval::SolveMethod::Progressive,eval::SolveMethod::Weighted,eval::SolveMethod::Chebyshev,eval::SolveMethod::ConjugateGradients}){
      for(double known:{0.0,lam*.98}){ if(m!=eval::SolveMethod::Chebyshev&&known>0)continue;
      int n6=0,n10=0,nres=0;
      for(int it=1;it<400&&!n10;++it){
        auto rep=in.Solve(s.positions,3,P,{.method=m,.tolerance=1e-15,.maxIterations=it,.lambdaMin=(m==eval::SolveMethod::Chebyshev?known:lam*.98)});
        double e=0;for(size_t i=0;i<P.size();++i)e+=(P[i]-exact[i])*(P[i]-exact[i]);e=std::sqrt(e/norm);
        if(!nres&&rep.residual<1e-6)nres=it;
        if(!n6&&e<1e-6)n6=it;
        if(!n10&&e<1e-10)n10=it;
      }
      fmt::print("  {}{} {}/{} (res {})",eval::GetName(m),known>0?"*":"",n6,n10,nres);}
    }
    fmt::print("\n");
  };
  if(argc>1&&std::string(argv[1])=="table"){
    errorApps("quad torus 96",test::MakeTorus(12,8));
    errorApps("quad torus 6144",test::MakeTorus(96,64));
    errorApps("quad sphere 26",test::MakeQuadSphere(1));
    errorApps("quad sphere 6146",test::MakeQuadSphere(5));
    { auto t=test::MakeIrregularTriangles(40,40,3); t.cage.scheme=Sdc::SCHEME_CATMARK; errorApps("irregular quads",test::Refine(t,1)); }
    errorApps("irregular tri Loop",test::MakeIrregularTriangles(50,40,3));
    errorApps("icosphere",test::MakeIcosphere(4));
    errorApps("bipyramid",test::MakeBipyramid(12));
    return 0;
  }
  int n=argc>1?atoi(argv[1]):408;
  auto t=test::MakeIrregularTriangles(n,n,3); t.cage.scheme=Sdc::SCHEME_CATMARK;
  auto s=test::Refine(t,1); test::AddNoise(s,0.1,1);
  auto r=far_ext::CreateRefiner(s.cage);
  fmt::print("n={}\n",s.cage.numVertices);
  for(int threads:{1,2,1}) bench::OnThreads(threads,[&]{
    auto t0=Clock::now(); eval::Interpolator in(*r); double b=since(t0);
    std::vector<double> P(s.positions.size());
    t0=Clock::now(); auto rep=in.Solve(s.positions,3,P,{}); double c=since(t0);
    t0=Clock::now(); auto rep2=in.Solve(s.positions,3,P,{.tolerance=1e-10}); double d=since(t0);
    t0=Clock::now(); in.GetOperator().Apply(s.positions,3,P); double e=since(t0);
    double c0=bench::GetProcessorTime(); in.Solve(s.positions,3,P,{}); double c1=bench::GetProcessorTime(); fmt::print("cpu solve {:.3f} ",c1-c0);
    fmt::print("T{} operator {:.3f} s ({:.1f} B/vertex), solve {:.3f} s {} its res {:.2e} {}; 1e-10 {:.3f} s {} its; apply {:.4f}\n",threads,b,double(in.GetOperator().GetNumBytes())/s.cage.numVertices,c,rep.iterations,rep.residual,eval::GetName(rep.method),d,rep2.iterations,e);
  });
  auto t0=Clock::now(); auto A=far_ext::LimitMatrix::Build(*r); fmt::print("matrix {:.3f}\n",since(t0));
  auto w=A.MakeFloatWeights(); std::vector<float> M(s.positions.begin(),s.positions.end()),P(M),Y(M.size());
  OpenSubdiv::Osd::BufferDescriptor rows(0,3,3);
  double cc=bench::GetProcessorTime(); t0=Clock::now(); int it=0; double size=eval::FindSize(s.positions,3);
  for(;it<400;++it){ OpenSubdiv::Osd::CpuEvaluator::EvalStencils(P.data(),rows,Y.data(),rows,A.GetSizes().data(),A.GetOffsets().data(),A.GetControlIndices().data(),w.data(),0,A.GetNumStencils());
    float mx=0; for(size_t i=0;i<M.size();i+=3){float q=0;for(size_t c=0;c<3;++c){float d=M[i+c]-Y[i+c];P[i+c]+=d;q+=d*d;} mx=std::max(mx,q);} if(std::sqrt(mx)<1e-6*size)break;}
  double o=since(t0); fmt::print("cpu {:.3f} ",bench::GetProcessorTime()-cc); fmt::print("Osd plain {} its {:.3f} s ({:.4f} per)\n",it+1,o,o/(it+1));
}
