function sys = bough_ss(path)
% BOUGH_SS  The linear model that `bough linearize` wrote, as ss with the names of its states, inputs and outputs.
%   sys = BOUGH_SS('arm.h5'); bode(sys), pole(sys). Needs the control toolbox (Octave: pkg load control). A sampled loop
%   has its sample time.
m = bough_read(path);
if ~strcmp(m.format, 'bough-linear'), error('bough_ss: %s is a file of %s', path, m.format); end
time = 0;
if isfield(m, 'sample_time'), time = m.sample_time; end
names = {'StateName', 'InputName', 'OutputName'};
if exist('OCTAVE_VERSION', 'builtin'), names = {'stname', 'inname', 'outname'}; end
sys = ss(m.A, m.B, m.C, m.D, time);
lists = {m.states.name, m.inputs.name, m.outputs.name};
for k = 1:3
  if ~isempty(lists{k}), sys = set(sys, names{k}, lists{k}); end
end
end
