function sys = bough_ss(path)
% BOUGH_SS  The linear model that `bough linearize` wrote, as ss with the names of its states, inputs and outputs.
%   sys = BOUGH_SS('arm.h5'); bode(sys), pole(sys). Needs the control toolbox (Octave: pkg load control). A sampled loop
%   has its sample time. Of a sweep an array of models, N1 x N2 ... over the parameters of a grid (MATLAB only; for
%   LPV: sys.SamplingGrid, lpvss).
m = bough_read(path);
is_sweep = strcmp(m.format, 'bough-sweep');
if ~is_sweep && ~strcmp(m.format, 'bough-linear'), error('bough_ss: %s is a file of %s', path, m.format); end
if is_sweep
  sizes = size(m.A, 1);
  if isfield(m, 'grid')
    sizes = zeros(1, numel(m.grid.name));
    for k = 1:numel(sizes), sizes(k) = numel(m.grid.(sprintf('axis%d', k))); end
  end
  for part = 'ABCD', m.(part) = to_grid(m.(part), sizes); end
end
time = 0;
if isfield(m, 'sample_time'), time = m.sample_time(1); end
names = {'StateName', 'InputName', 'OutputName'};
if exist('OCTAVE_VERSION', 'builtin'), names = {'stname', 'inname', 'outname'}; end
sys = ss(m.A, m.B, m.C, m.D, time);
lists = {m.states.name, m.inputs.name, m.outputs.name};
for k = 1:3
  if ~isempty(lists{k}), sys = set(sys, names{k}, lists{k}); end
end
end

function grid = to_grid(points, sizes)
% points x rows x columns, the last parameter fastest, to rows x columns x N1 x N2 ...
rows = size(points, 2);
columns = size(points, 3);
n = numel(sizes);
grid = reshape(permute(points, [2 3 1]), [rows columns fliplr(sizes) 1]);
grid = permute(grid, [1 2 2 + (n:-1:1)]);
end
