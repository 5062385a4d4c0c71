#pragma once

namespace manoscope::report {

/// Style sheet of report.html. Figures stay on white in the dark scheme too.
inline constexpr const char* kStyle = R"(
:root{--ink:#1c2430;--soft:#5a6675;--line:#d5dbe2;--paper:#ffffff;--ground:#f4f6f8;--accent:#00568c;
--good:#00694c;--half:#7a5300;--bad:#a8320f;--share:0%;--bar:#cfe3f1;color-scheme:light dark}
@media screen and (prefers-color-scheme:dark){:root{--ink:#e4e9ef;--soft:#a3afbd;--line:#3a4552;--paper:#1d242d;
--ground:#141a21;--accent:#7cc4f0;--good:#5fd1a8;--half:#f0c05a;--bad:#ff9b78;--bar:#24506e}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,Helvetica,Arial,sans-serif}
main{max-width:1400px;margin:0 auto;padding:1.5rem 1.25rem 4rem}
h1{font-size:1.9rem;line-height:1.2;margin:.2rem 0 .3rem;overflow-wrap:anywhere}
h2{font-size:1.3rem;margin:2.4rem 0 .8rem;padding-bottom:.25rem;border-bottom:1px solid var(--line)}
p{max-width:50rem}
.by{color:var(--soft);margin:0 0 1.2rem}
nav{font-size:.95rem;margin:0 0 1.2rem}
nav a{margin-right:1rem}
a{color:var(--accent)}
section.card,div.scroll{background:var(--paper);border:1px solid var(--line);border-radius:8px}
section.card{padding:.4rem 1.1rem}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:.25rem 1.2rem;margin:.6rem 0}
section.card p{max-width:none;margin:.4rem 0}
@media (min-width:1000px){.facts.short{grid-template-columns:max-content 1fr max-content 1fr}}
.facts dt{color:var(--soft)}
.facts dd{margin:0}
div.scroll{overflow-x:auto;margin:1rem 0;padding:.2rem .8rem .6rem}
div.tall{max-height:34rem;overflow:auto}
div.tall thead th{position:sticky;top:0;background:var(--paper)}
table{border-collapse:collapse;font-size:.94rem;font-variant-numeric:tabular-nums;width:100%}
p.caption{color:var(--soft);font-size:.94rem;margin:1.2rem 0 -.4rem;max-width:60rem}
th,td{padding:.34rem .6rem;text-align:right;border-top:1px solid var(--line);white-space:nowrap}
thead th{border-top:0;border-bottom:2px solid var(--line);vertical-align:bottom;white-space:normal;font-weight:600}
th:first-child,td:first-child,.words{text-align:left}
td.words{white-space:normal}
td.share{background:linear-gradient(to left,var(--bar) var(--share),transparent 0)}
.good{color:var(--good);font-weight:600}
.half{color:var(--half);font-weight:600}
.bad{color:var(--bad);font-weight:600}
.none{color:var(--soft)}
ul.warnings{border-left:4px solid var(--bad);background:var(--paper);margin:1rem 0;padding:.7rem 1rem .7rem 2rem;border-radius:0 8px 8px 0}
div.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,560px),1fr));gap:1.2rem}
figure{margin:0;background:#fff;color:#1c2430;border:1px solid var(--line);border-radius:8px;padding:.9rem;min-width:0}
figure.wide{grid-column:1/-1}
figure svg{display:block;width:100%;height:auto;margin:0 auto}
figure.wide svg{max-width:1080px}
figcaption{font-size:.94rem;color:#3b4653;margin:.5rem auto 0;max-width:56rem}
figcaption b{display:block;color:#1c2430}
pre{background:var(--paper);border:1px solid var(--line);border-radius:8px;padding:.8rem 1rem;overflow:auto;max-height:28rem;font:14px/1.45 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
details{margin:.6rem 0}
summary{cursor:pointer;font-weight:600}
code{font-family:ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;font-size:.94em}
@media (max-width:900px){table{font-size:.86rem}th,td{padding:.3rem .4rem}}
@media screen{figure,div.scroll{content-visibility:auto;contain-intrinsic-size:auto 480px}}
@page{size:A4;margin:13mm 12mm}
@media print{body{background:#fff;font-size:10pt}main{max-width:none;padding:0}nav{display:none}
h1{font-size:17pt}h2{font-size:13pt;break-after:avoid}p.caption{font-size:8.5pt;break-after:avoid;max-width:none}
div.figures{display:block}figure{break-inside:avoid;margin:0 0 5mm}figure svg{max-width:135mm;max-height:120mm}
figure.wide svg{max-width:100%}figcaption{font-size:8.5pt;max-width:none}
div.scroll,div.tall{overflow:visible;max-height:none;padding:0;border:0}div.tall thead th{position:static}
table{font-size:6.8pt}th,td{padding:.1rem .13rem;white-space:normal}thead th{overflow-wrap:anywhere;hyphens:auto}tr{break-inside:avoid}
pre{max-height:none;white-space:pre-wrap;font-size:8pt}}
)";

}  // namespace manoscope::report
