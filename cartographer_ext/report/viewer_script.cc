// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/style.h"

namespace cartographer_ext {
namespace report {

namespace {

constexpr char kViewerScript[] = R"js(
(function(){
var space=(document.querySelector('svg')||document.body).namespaceURI,data=document.getElementById('scans');
var scans=data?JSON.parse(data.textContent):{};
function make(name,parent,text){var e=document.createElement(name);
if(text)e.textContent=text;parent.appendChild(e);return e;}
function view(svg){
var box=svg.viewBox.baseVal,home=[box.x,box.y,box.width,box.height];
var frame=document.createElement('div'),at=home.slice(),fingers={},moved=0;
frame.className='viewer';svg.parentNode.insertBefore(frame,svg);
frame.appendChild(svg);svg.tabIndex=0;
function show(){svg.setAttribute('viewBox',at.join(' '));
svg.style.setProperty('--zoom',at[2]/home[2]);
frame.classList.toggle('zoomed',at[2]<home[2]*.999);}
function place(x,y){var r=svg.getBoundingClientRect();
var s=Math.max(at[2]/r.width,at[3]/r.height);
return [at[0]+at[2]/2+(x-r.left-r.width/2)*s,
at[1]+at[3]/2+(y-r.top-r.height/2)*s,s];}
function limit(){for(var i=0;i<2;i++){
at[i]=Math.min(Math.max(at[i],home[i]-at[i+2]/2),
home[i]+home[i+2]-at[i+2]/2);}}
function zoom(f,p){var w=Math.min(home[2],Math.max(home[2]/400,at[2]*f));
f=w/at[2];at=[p[0]-(p[0]-at[0])*f,p[1]-(p[1]-at[1])*f,w,at[3]*f];
if(w>=home[2])at=home.slice();limit();show();}
function middle(){return [at[0]+at[2]/2,at[1]+at[3]/2];}
function go(x,y,w){var f=Math.min(.4,w/home[2]);
at=[x-home[2]*f/2,y-home[3]*f/2,home[2]*f,home[3]*f];limit();show();}
function shift(x,y){at[0]+=x;at[1]+=y;limit();show();}
function reset(){at=home.slice();show();}
svg.addEventListener('wheel',function(e){
if(!e.ctrlKey&&document.activeElement!==svg)return;
e.preventDefault();zoom(Math.pow(1.0015,e.deltaY),place(e.clientX,e.clientY));
},{passive:false});
svg.addEventListener('pointerdown',function(e){
fingers[e.pointerId]=[e.clientX,e.clientY];moved=0;});
svg.addEventListener('pointermove',function(e){
var was=fingers[e.pointerId],ids=Object.keys(fingers);if(!was)return;
var now=[e.clientX,e.clientY],s=place(0,0)[2];
if(ids.length===2){
var o=fingers[ids[0]===String(e.pointerId)?ids[1]:ids[0]];
var a=Math.hypot(was[0]-o[0],was[1]-o[1]),b=Math.hypot(now[0]-o[0],now[1]-o[1]);
if(a>0&&b>0)zoom(a/b,place((now[0]+o[0])/2,(now[1]+o[1])/2));moved=9;
}else if(at[2]<home[2]*.999){
shift((was[0]-now[0])*s,(was[1]-now[1])*s);
}
moved+=Math.hypot(now[0]-was[0],now[1]-was[1]);fingers[e.pointerId]=now;});
['pointerup','pointercancel','pointerleave'].forEach(function(name){
svg.addEventListener(name,function(e){delete fingers[e.pointerId];});});
svg.addEventListener('dblclick',function(e){
zoom(.5,place(e.clientX,e.clientY));});
svg.addEventListener('keydown',function(e){
var step={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,-1],ArrowDown:[0,1]}
[e.key];
if(step)shift(step[0]*at[2]*.1,step[1]*at[3]*.1);
else if(e.key==='+'||e.key==='=')zoom(.7,middle());
else if(e.key==='-')zoom(1/.7,middle());
else if(e.key==='0')reset();
else return;
e.preventDefault();});
var tools=make('div',frame);tools.className='tools';
[['+','Closer',function(){zoom(.7,middle());}],
['\u2212','Farther',function(){zoom(1/.7,middle());}],
['\u2922','Show all',reset]].forEach(function(t){
var b=make('button',tools,t[0]);b.type='button';
b.setAttribute('aria-label',t[1]);b.title=t[1];b.addEventListener('click',t[2]);});
layers(svg,frame);
time(svg,frame,svg.querySelectorAll('[data-t]'));
var marks=svg.querySelectorAll('.loop[data-loop],.ring[data-name]');
if(marks.length)choose(svg,frame,marks,go,function(){return moved<5;});}
function layers(svg,frame){
var legend=frame.nextElementSibling;
if(!legend||!legend.classList.contains('legend'))return;
var entries=Array.prototype.slice.call(legend.children);
entries.forEach(function(old){
var style=(old.dataset.style||'').split(' ').map(function(c){
return '.'+c;}).join(''),b=document.createElement('button');
b.type='button';b.className='entry';b.innerHTML=old.innerHTML;
b.setAttribute('aria-pressed','true');legend.replaceChild(b,old);
b.addEventListener('click',function(){
var on=b.getAttribute('aria-pressed')==='false';
b.setAttribute('aria-pressed',on);
svg.querySelectorAll(style).forEach(function(e){
e.classList.toggle('off',!on);});});});
var maps=svg.querySelectorAll('use.map');
if(!maps.length)return;
var b=make('button',legend,'map');b.type='button';b.className='entry';
b.setAttribute('aria-pressed','true');
b.addEventListener('click',function(){
var on=b.getAttribute('aria-pressed')==='false';
b.setAttribute('aria-pressed',on);
maps.forEach(function(e){e.classList.toggle('off',!on);});});}
function time(svg,frame,events){
var last=0;events.forEach(function(e){last=Math.max(last,+e.dataset.t);});
if(!(last>0))return;
var label=make('label',frame);label.className='slider time';
make('span',label,'Until');
var input=make('input',label);input.type='range';input.min=0;
input.max=Math.ceil(last);input.value=input.max;
var text=make('span',label);
function set(){text.textContent=input.value+' s';
events.forEach(function(e){
e.style.visibility=+e.dataset.t<=+input.value?'':'hidden';});}
input.addEventListener('input',set);set();}
function dots(svg,points,pose,kind){
var u=+svg.dataset.units,x0=+svg.dataset.x,y0=+svg.dataset.y,d='';
var c=Math.cos(pose[2]),s=Math.sin(pose[2]);
for(var i=0;i+1<points.length;i+=2){
var x=points[i]/100,y=points[i+1]/100;
d+='M'+((pose[0]+c*x-s*y-x0)*u).toFixed(2)+' '+
((y0-pose[1]-s*x-c*y)*u).toFixed(2)+'h0';}
var path=document.createElementNS(space,'path');
path.setAttribute('class','scan '+kind);path.setAttribute('d',d);
svg.appendChild(path);}
function numbers(t){return t.split(' ').map(Number);}
function drawn(svg,node,pose,kind){
if(scans[node])dots(svg,scans[node],pose,kind);return !!scans[node];}
function loop(svg,panel,line){
var id=line.dataset.id,node=id.split(':').slice(2).join(':');
var map=numbers(line.dataset.map);
var any=drawn(svg,node,numbers(line.dataset.loop),'loop-scan');
drawn(svg,node,map,'map-scan');
make('div',panel,any?'Scan: blue at the pose of the loop, orange at the pose '+
'in the map.':'The scan is not included in this page.');
var refused=line.classList.contains('s6');
make('div',panel,refused?'Add: ':'Remove: ').appendChild(
document.createElement('code')).textContent=
refused?'-add_loops '+id+':'+line.dataset.pose:'-drop_loops '+id;
return map;}
function spot(svg,panel,ring){
var box=ring.getBBox(),u=+svg.dataset.units,words=ring.dataset.words;
[['other','loop-scan'],['scan','map-scan']].forEach(function(s){
var t=ring.dataset[s[0]];if(!t)return;
drawn(svg,t.split(' ')[0],numbers(t).slice(1),s[1]);});
if(words)make('div',panel,words);
return [(box.x+box.width/2)/u+(+svg.dataset.x),
+svg.dataset.y-(box.y+box.height/2)/u];}
function choose(svg,frame,marks,go,still){
var panel=make('div',frame);panel.className='evidence off';
panel.setAttribute('aria-live','polite');
function clear(){svg.querySelectorAll('.scan').forEach(function(e){e.remove();});
marks.forEach(function(m){m.classList.remove('chosen');});
panel.textContent='';panel.classList.add('off');}
function near(at){var u=+svg.dataset.units;
go((at[0]-(+svg.dataset.x))*u,(+svg.dataset.y-at[1])*u,30*u);}
function open(mark){
clear();mark.classList.add('chosen');
make('div',panel,mark.querySelector('title').textContent);
var at=(mark.dataset.loop?loop:spot)(svg,panel,mark);
[['Show',function(){near(at);}],['Close',clear]].forEach(function(b){
var button=make('button',panel,b[0]);button.type='button';
button.addEventListener('click',b[1]);});
panel.classList.remove('off');return at;}
function link(parent,ring){
var b=make('button',parent,'Show');b.type='button';b.className='show';
b.addEventListener('click',function(){near(open(ring));
svg.scrollIntoView({block:'center'});});}
var rings=0,table=frame.parentNode.nextElementSibling;
var rows=table?table.querySelectorAll('tbody tr'):[];
marks.forEach(function(mark){
mark.addEventListener('click',function(){if(still())open(mark);});
if(!mark.dataset.name)return;
document.querySelectorAll('.verdict li').forEach(function(li){
if(li.textContent.indexOf(mark.dataset.name)>=0)link(li,mark);});
if(rows[rings])link(rows[rings].lastElementChild,mark);
rings++;});}
document.querySelectorAll('svg.map-figure').forEach(view);
})();
)js";

}  // namespace

const char* ViewerScript() { return kViewerScript; }

}  // namespace report
}  // namespace cartographer_ext
